// SPDX-License-Identifier: Apache-2.0
#include "shaders/compile/spirv_reader.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>
#include <utility>

namespace helio {
namespace {

// Numbers of the SPIR-V 1.6 specification, sections 3.7, 3.8, 3.20 and 3.49.
constexpr u32 kMagic = 0x07230203;
enum Op : u32
{
    kOpName = 5,
    kOpMemberName = 6,
    kOpTypeInt = 21,
    kOpTypeFloat = 22,
    kOpTypeVector = 23,
    kOpTypeMatrix = 24,
    kOpTypeImage = 25,
    kOpTypeSampler = 26,
    kOpTypeSampledImage = 27,
    kOpTypeArray = 28,
    kOpTypeRuntimeArray = 29,
    kOpTypeStruct = 30,
    kOpTypePointer = 32,
    kOpConstant = 43,
    kOpVariable = 59,
    kOpDecorate = 71,
    kOpMemberDecorate = 72,
};
enum Decoration : u32
{
    kArrayStride = 6,
    kMatrixStride = 7,
    kBinding = 33,
    kDescriptorSet = 34,
    kOffset = 35
};
enum StorageClass : u32
{
    kUniformConstant = 0,
    kUniform = 2,
    kPushConstant = 9,
    kStorageBuffer = 12
};
constexpr u32 kDimBuffer = 5;
constexpr u32 kMaxPushBytes = 128;

struct Type
{
    u32 op = 0;
    std::vector<u32> operands; // words after the result id
};

std::string textOf(std::span<const u32> words)
{
    std::string text;
    for (const u32 word : words) {
        for (u32 shift = 0; shift < 32; shift += 8) {
            const char c = char(word >> shift & 0xFF);
            if (c == 0) return text;
            text += c;
        }
    }
    return text;
}

class Reader
{
public:
    Status scan(std::span<const u32> words);
    Result<SpirvModule> summarise() const;

private:
    struct Variable
    {
        u32 id;
        u32 pointerType;
        u32 storage;
    };

    void note(u32 op, std::span<const u32> operands);
    u32 bytesOf(u32 typeId, u32 matrixStride) const;
    u32 decoration(u32 id, u32 kind, u32 otherwise) const;
    u32 memberDecoration(u32 id, u32 member, u32 kind, u32 otherwise) const;
    SpirvStruct structOf(u32 id, const Type& type) const;
    Result<BindingKind> kindOf(u32 typeId, u32 storage) const;
    std::string nameOf(u32 id) const { return names_.count(id) ? names_.at(id) : concat("%", id); }

    std::map<u32, std::string> names_;
    std::map<std::pair<u32, u32>, std::string> memberNames_;
    std::map<u32, Type> types_;
    std::map<u32, u32> constants_;
    std::map<std::pair<u32, u32>, u32> decorations_;                       // (id, kind) -> value
    std::map<std::pair<std::pair<u32, u32>, u32>, u32> memberDecorations_; // ((id, member), kind) -> value
    std::vector<Variable> variables_;
};

Status Reader::scan(std::span<const u32> words)
{
    if (words.size() < 5 || words[0] != kMagic) return Error{"not a SPIR-V module: wrong magic number"};
    for (size_t at = 5; at < words.size();) {
        const u32 count = words[at] >> 16;
        if (count == 0 || at + count > words.size()) return Error{concat("truncated SPIR-V: instruction at word ", at)};
        note(words[at] & 0xFFFF, words.subspan(at + 1, count - 1));
        at += count;
    }
    return Nothing{};
}

void Reader::note(u32 op, std::span<const u32> operands)
{
    switch (op) {
    case kOpName:
        if (operands.size() >= 2) names_[operands[0]] = textOf(operands.subspan(1));
        break;
    case kOpMemberName:
        if (operands.size() >= 3) memberNames_[{operands[0], operands[1]}] = textOf(operands.subspan(2));
        break;
    case kOpConstant:
        if (operands.size() >= 3) constants_[operands[1]] = operands[2];
        break;
    case kOpVariable:
        if (operands.size() >= 3) variables_.push_back({operands[1], operands[0], operands[2]});
        break;
    case kOpDecorate:
        if (operands.size() >= 3) decorations_[{operands[0], operands[1]}] = operands[2];
        break;
    case kOpMemberDecorate:
        if (operands.size() >= 4) memberDecorations_[{{operands[0], operands[1]}, operands[2]}] = operands[3];
        break;
    default:
        if (op >= kOpTypeInt && op <= kOpTypePointer && !operands.empty()) {
            types_[operands[0]] = {op, {operands.begin() + 1, operands.end()}};
        }
    }
}

u32 Reader::decoration(u32 id, u32 kind, u32 otherwise) const
{
    const auto found = decorations_.find({id, kind});
    return found == decorations_.end() ? otherwise : found->second;
}

u32 Reader::memberDecoration(u32 id, u32 member, u32 kind, u32 otherwise) const
{
    const auto found = memberDecorations_.find({{id, member}, kind});
    return found == memberDecorations_.end() ? otherwise : found->second;
}

u32 Reader::bytesOf(u32 typeId, u32 matrixStride) const
{
    const auto found = types_.find(typeId);
    if (found == types_.end()) return 0;
    const Type& type = found->second;
    switch (type.op) {
    case kOpTypeInt:
    case kOpTypeFloat:
        return type.operands[0] / 8;
    case kOpTypeVector:
        return bytesOf(type.operands[0], 0) * type.operands[1];
    case kOpTypeMatrix:
        return matrixStride * type.operands[1];
    case kOpTypeArray: {
        const auto length = constants_.find(type.operands[1]);
        return length == constants_.end() ? 0 : decoration(typeId, kArrayStride, 0) * length->second;
    }
    case kOpTypeStruct: {
        u32 bytes = 0;
        for (u32 i = 0; i < type.operands.size(); ++i) {
            const u32 stride = memberDecoration(typeId, i, kMatrixStride, 0);
            bytes = std::max(bytes, memberDecoration(typeId, i, kOffset, 0) + bytesOf(type.operands[i], stride));
        }
        return bytes;
    }
    default:
        return 0;
    }
}

SpirvStruct Reader::structOf(u32 id, const Type& type) const
{
    SpirvStruct result;
    result.name = nameOf(id);
    for (u32 i = 0; i < type.operands.size(); ++i) {
        SpirvMember member;
        const auto name = memberNames_.find({id, i});
        member.name = name == memberNames_.end() ? concat("#", i) : name->second;
        member.offset = memberDecoration(id, i, kOffset, kNoIndex);
        member.matrixStride = memberDecoration(id, i, kMatrixStride, 0);
        member.arrayStride = decoration(type.operands[i], kArrayStride, 0);
        member.bytes = bytesOf(type.operands[i], member.matrixStride);
        result.members.push_back(std::move(member));
    }
    for (const auto& [arrayId, array] : types_) {
        const bool isArray = array.op == kOpTypeArray || array.op == kOpTypeRuntimeArray;
        if (isArray && array.operands[0] == id)
            result.stride = std::max(result.stride, decoration(arrayId, kArrayStride, 0));
    }
    return result;
}

Result<BindingKind> Reader::kindOf(u32 typeId, u32 storage) const
{
    const auto found = types_.find(typeId);
    if (found == types_.end()) return Error{"a descriptor of unknown type"};
    const Type& type = found->second;
    if (storage == kStorageBuffer && type.op == kOpTypeStruct) return BindingKind::StorageBuffer;
    if (storage == kUniform && type.op == kOpTypeStruct) return BindingKind::UniformBlock;
    if (type.op == kOpTypeSampledImage) {
        const Type& image = types_.at(type.operands[0]);
        return image.operands[1] == kDimBuffer ? BindingKind::UniformTexelBuffer : BindingKind::SampledImage;
    }
    if (type.op == kOpTypeImage) {
        // Operands: sampled type, dim, depth, arrayed, multisampled, sampled (1 = with a sampler, 2 = storage), format.
        if (type.operands[1] == kDimBuffer && type.operands[5] == 1) return BindingKind::UniformTexelBuffer;
        if (type.operands[5] == 2)
            return type.operands[1] == kDimBuffer ? BindingKind::StorageTexelBuffer : BindingKind::StorageImage;
        return Error{"a separate image or a storage texel buffer; use a combined sampler, image2D or a storage buffer"};
    }
    return Error{"an array of descriptors or a kind of descriptor that is not in use"};
}

Result<SpirvModule> Reader::summarise() const
{
    SpirvModule module;
    for (const Variable& variable : variables_) {
        const auto pointer = types_.find(variable.pointerType);
        if (pointer == types_.end() || pointer->second.op != kOpTypePointer) continue;
        const u32 pointee = pointer->second.operands[1];
        if (variable.storage == kPushConstant) {
            module.pushBytes = bytesOf(pointee, 0);
            continue;
        }
        const u32 binding = decoration(variable.id, kBinding, kNoIndex);
        if (binding == kNoIndex) continue;
        const std::string name = types_.at(pointee).op == kOpTypeStruct ? nameOf(pointee) : nameOf(variable.id);
        if (decoration(variable.id, kDescriptorSet, 0) != 0)
            return Error{concat("'", name, "' is not in descriptor set 0")};
        const Result<BindingKind> kind = kindOf(pointee, variable.storage);
        if (!kind) return Error{concat("'", name, "' is ", kind.error().message)};
        module.bindings.push_back({binding, *kind});
    }
    std::sort(module.bindings.begin(), module.bindings.end(),
              [](const ShaderBinding& a, const ShaderBinding& b) { return a.binding < b.binding; });
    for (size_t i = 1; i < module.bindings.size(); ++i) {
        if (module.bindings[i].binding == module.bindings[i - 1].binding) {
            return Error{concat("two resources have binding ", module.bindings[i].binding)};
        }
    }
    if (module.pushBytes > kMaxPushBytes) {
        return Error{concat(module.pushBytes, " bytes of push constants; every device has only ", kMaxPushBytes)};
    }
    for (const auto& [id, type] : types_) {
        if (type.op == kOpTypeStruct) module.structs.push_back(structOf(id, type));
    }
    return module;
}

} // namespace

Result<SpirvModule> readSpirv(std::span<const u32> words)
{
    Reader reader;
    if (Status status = reader.scan(words); !status) return status.error();
    return reader.summarise();
}

} // namespace helio
