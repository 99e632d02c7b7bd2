// SPDX-License-Identifier: Apache-2.0
#include "shaders/compile/glsl_compiler.h"

#include <filesystem>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>
#include <memory>
#include <set>
#include <sstream>

#include "city/base/file.h"

namespace helio {
namespace {

/// Resolves includes on disk and remembers what was opened, for the dependency file.
class Includer : public glslang::TShader::Includer
{
public:
    explicit Includer(const std::vector<std::string>& folders) : folders_(folders) {}

    IncludeResult* includeLocal(const char* header, const char* includer, size_t /*depth*/) override
    {
        return open(std::filesystem::path(includer).parent_path() / header);
    }
    IncludeResult* includeSystem(const char* header, const char* /*includer*/, size_t /*depth*/) override
    {
        for (const std::string& folder : folders_) {
            if (IncludeResult* result = open(std::filesystem::path(folder) / header)) return result;
        }
        return nullptr;
    }
    void releaseInclude(IncludeResult* result) override
    {
        if (!result) return;
        delete static_cast<std::string*>(result->userData);
        delete result;
    }
    const std::set<std::string>& opened() const { return opened_; }

private:
    IncludeResult* open(const std::filesystem::path& path)
    {
        if (!std::filesystem::is_regular_file(path)) return nullptr;
        Result<std::string> text = readTextFile(path);
        if (!text) return nullptr;
        const std::string name = path.lexically_normal().string();
        opened_.insert(name);
        auto owned = std::make_unique<std::string>(std::move(*text));
        const char* data = owned->data();
        const size_t size = owned->size();
        return new IncludeResult(name, data, size, owned.release());
    }

    const std::vector<std::string>& folders_;
    std::set<std::string> opened_;
};

/// glslang writes "ERROR: file:line: what"; compilers and editors write "file:line: error: what".
std::string editorLines(const std::string& log)
{
    std::istringstream in(log);
    std::string line;
    std::string out;
    while (std::getline(in, line)) {
        for (const char* kind : {"ERROR: ", "WARNING: "}) {
            const std::string prefix = kind;
            if (line.rfind(prefix, 0) != 0) continue;
            const size_t message = line.find(": ", prefix.size());
            if (message == std::string::npos) {
                line.clear(); // "2 compilation errors. No code generated."
                continue;
            }
            const char* word = prefix[0] == 'E' ? ": error" : ": warning";
            line = line.substr(prefix.size(), message - prefix.size()) + word + line.substr(message);
        }
        if (!line.empty()) out += (out.empty() ? "" : "\n") + line;
    }
    return out;
}

struct GlslangProcess
{
    GlslangProcess() { glslang::InitializeProcess(); }
    ~GlslangProcess() { glslang::FinalizeProcess(); }
    GlslangProcess(const GlslangProcess&) = delete;
    GlslangProcess& operator=(const GlslangProcess&) = delete;
};

} // namespace

Result<CompiledShader> compileGlsl(const GlslSource& source)
{
    CompiledShader compiled;
    EShLanguage language = EShLangCompute;
    const std::string extension = std::filesystem::path(source.path).extension().string();
    if (extension == ".vert") {
        compiled.stage = ShaderStage::Vertex;
        language = EShLangVertex;
    } else if (extension == ".frag") {
        compiled.stage = ShaderStage::Fragment;
        language = EShLangFragment;
    } else if (extension != ".comp") {
        return Error{concat(source.path, ": error: unknown shader stage '", extension, "'; use .comp, .vert or .frag")};
    }
    const Result<std::string> text = readTextFile(source.path);
    if (!text) return text.error();

    std::string preamble = "#extension GL_GOOGLE_include_directive : enable\n";
    for (const std::string& define : source.defines) {
        const size_t equals = define.find('=');
        preamble += "#define " + define.substr(0, equals) + " " +
                    (equals == std::string::npos ? std::string("1") : define.substr(equals + 1)) + "\n";
    }

    const GlslangProcess process;
    glslang::TShader shader(language);
    const char* string = text->c_str();
    const int length = int(text->size());
    const char* name = source.path.c_str();
    shader.setStringsWithLengthsAndNames(&string, &length, &name, 1);
    shader.setPreamble(preamble.c_str());
    shader.setEnvInput(glslang::EShSourceGlsl, language, glslang::EShClientVulkan, 100);
    shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_3);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_6);
    const auto messages = EShMessages(EShMsgSpvRules | EShMsgVulkanRules);
    Includer includer(source.includeFolders);
    if (!shader.parse(GetDefaultResources(), 460, false, messages, includer)) {
        return Error{editorLines(shader.getInfoLog())};
    }
    glslang::TProgram program;
    program.addShader(&shader);
    if (!program.link(messages)) {
        return Error{concat(source.path, ": error: ", editorLines(program.getInfoLog()))};
    }
    glslang::SpvOptions options;
    options.disableOptimizer = true;
    glslang::GlslangToSpv(*program.getIntermediate(language), compiled.words, &options);
    compiled.includes.assign(includer.opened().begin(), includer.opened().end());
    return compiled;
}

} // namespace helio
