// SPDX-License-Identifier: Apache-2.0
// What a pass may record.
#pragma once
#include <initializer_list>
#include <optional>
#include <span>
#include <variant>

#include "engine/graph/frame_graph.h"

namespace helio {

/// A graph resource for one binding of set 0.
struct Binding
{
    Bound how; // buffer and image are filled in from the reference
    std::variant<Ref<Buffer>, Ref<Image>> what;
};

/// Storage buffer; a range needs an offset that is a multiple of 256 bytes.
Binding storage(u32 binding, Ref<Buffer> buffer, u64 offset = 0, u64 bytes = 0);
/// Read-only buffer that the shader reads as a texel buffer, or as a storage buffer in its fallback variant: which of
/// the two follows from the shader.
Binding texels(u32 binding, Ref<Buffer> buffer, VkFormat format);
/// Storage image (image2D and its kin).
Binding storage(u32 binding, Ref<Image> image, ImagePart part = {});
/// Image with sampler.
Binding sampled(u32 binding, Ref<Image> image, Sampler sampler, ImagePart part = {});

struct ColorAttachment
{
    Ref<Image> image;
    std::optional<VkClearColorValue> clear = {}; // none = keep the contents
    u32 layer = 0;
};

struct DepthAttachment
{
    Ref<Image> image;
    std::optional<float> clear = {}; // none = keep the contents
    u32 layer = 0;
};

struct RenderTargets
{
    std::vector<ColorAttachment> colors = {};
    std::optional<DepthAttachment> depth = {};
    /// Area in texels; 0 = the size of the first attachment.
    u32 width = 0;
    u32 height = 0;
    u32 x = 0;
    u32 y = 0;
};

/// Draws between the begin and the end of rendering. Exists inside PassContext::render only.
class Drawing
{
public:
    /// Colour and depth formats are taken from the targets: leave them out of the description.
    void pipeline(GraphicsPipelineDesc desc);
    /// Resources of the pipeline that was set last.
    void bind(std::span<const Binding> bindings);
    void bind(std::initializer_list<Binding> bindings) { bind(std::span(bindings.begin(), bindings.size())); }
    template <class Params> void push(const Params& params)
    {
        static_assert(std::is_trivially_copyable_v<Params> && sizeof(Params) <= 128);
        pushBytes(std::as_bytes(std::span(&params, 1)));
    }
    void vertices(u32 slot, Ref<Buffer> buffer, u64 offset = 0);
    /// u32 indices.
    void indices(Ref<Buffer> buffer, u64 offset = 0);
    /// Constant and slope factor of a pipeline with depthBias, in units of the depth format and of the slope.
    void depthBias(float constant, float slope);
    void scissor(u32 x, u32 y, u32 width, u32 height);
    void draw(u32 vertexCount, u32 instanceCount = 1, u32 firstVertex = 0, u32 firstInstance = 0);
    void drawIndexed(u32 indexCount, u32 instanceCount = 1, u32 firstIndex = 0, i32 vertexOffset = 0,
                     u32 firstInstance = 0);
    /// `count` records of VkDrawIndexedIndirectCommand (Use::Indirect); one call per record on devices without
    /// multi-draw. firstInstance must be 0 on devices without drawIndirectFirstInstance.
    void drawIndexedIndirect(Ref<Buffer> arguments, u64 offset, u32 count);

private:
    friend class PassContext;
    Drawing(PassContext& context, const RenderTargets& targets) : context_(context), targets_(targets) {}
    void pushBytes(std::span<const std::byte> bytes);

    PassContext& context_;
    const RenderTargets& targets_;
    const Pipeline* pipeline_ = nullptr;
};

/// Given to a pass's record function. Every reference must have been declared by this pass: anything else aborts with
/// the names of pass and resource.
class PassContext
{
public:
    Context& context() const;
    VkCommandBuffer commands() const { return recorder_.commands(); }
    Recorder& recorder() const { return recorder_; }
    const Buffer& buffer(Ref<Buffer> ref) const;
    const Image& image(Ref<Image> ref) const;

    /// One dispatch. Push constants must have exactly the size of the shader's block.
    template <class Params>
    void dispatch(const ShaderCode& shader, std::initializer_list<Binding> bindings, const Params& params,
                  Groups groups, std::vector<SpecConstant> constants = {})
    {
        static_assert(std::is_trivially_copyable_v<Params> && sizeof(Params) <= 128);
        dispatchBytes(shader, std::span(bindings.begin(), bindings.size()), std::as_bytes(std::span(&params, 1)),
                      groups, std::move(constants));
    }
    /// A dispatch without push constants.
    void dispatch(const ShaderCode& shader, std::initializer_list<Binding> bindings, Groups groups,
                  std::vector<SpecConstant> constants = {})
    {
        dispatchBytes(shader, std::span(bindings.begin(), bindings.size()), {}, groups, std::move(constants));
    }
    /// For bindings and push constants whose number is known only at run time.
    void dispatchBytes(const ShaderCode& shader, std::span<const Binding> bindings, std::span<const std::byte> params,
                       Groups groups, std::vector<SpecConstant> constants);

    /// Between dispatches (and copies) of one pass: what was written before is seen after.
    void barrier();

    /// Fills a buffer with a 32-bit value (Use::CopyTo).
    void fill(Ref<Buffer> buffer, u32 value);
    /// Copies bytes (Use::CopyFrom, Use::CopyTo); bytes 0 = the smaller of the two sizes.
    void copy(Ref<Buffer> from, Ref<Buffer> to, u64 bytes = 0, u64 fromOffset = 0, u64 toOffset = 0);
    /// Copies one layer, rows tightly packed, to a buffer at an offset in bytes.
    void copy(Ref<Image> from, u32 layer, Ref<Buffer> to, u64 toOffset = 0);

    /// Begins rendering to the targets (viewport and scissor set to them, clip-space +y up), calls `body`, ends.
    void render(const RenderTargets& targets, const std::function<void(Drawing&)>& body);

private:
    friend class FrameGraph;
    friend class Drawing;
    PassContext(const FrameGraph& graph, u32 pass, Recorder& recorder) : graph_(graph), pass_(pass), recorder_(recorder)
    {
    }
    /// Did this pass declare the resource (with one of these uses, if there are any)?
    bool declares(u32 resource, std::initializer_list<Use> uses) const;
    void checkDeclared(u32 resource, std::initializer_list<Use> uses) const;
    std::vector<Bound> resolve(std::span<const Binding> bindings) const;

    const FrameGraph& graph_;
    u32 pass_;
    Recorder& recorder_;
};

/// Adds a pass that fills a buffer with a 32-bit value; returns the filled version.
[[nodiscard]] Ref<Buffer> addFill(FrameGraph& graph, Ref<Buffer> buffer, u32 value);
/// Adds a pass that copies a buffer, or a layer of an image, to a Readback buffer and leaves it for the host: after
/// Recorder::wait call host.invalidate() and read host.mapped().
void addReadback(FrameGraph& graph, Ref<Buffer> from, const Buffer& host);
void addReadback(FrameGraph& graph, Ref<Image> from, u32 layer, const Buffer& host);

} // namespace helio
