// SPDX-License-Identifier: Apache-2.0
// The frame graph: passes declare what they read and write, the graph derives order checks, memory and barriers.
//
//     auto to = graph.addPass("gather", [&](PassBuilder& pass) {         // setup: runs now, may capture by reference
//         pass.read(links, Use::ComputeRead);
//         const auto out = pass.write(pass.create(BufferDesc{"irradiance", bytes}), Use::ComputeWrite);
//         pass.record([=](PassContext& ctx) {                             // record: runs at execute, captures by value
//         only
//             ctx.dispatch(shaders::kGatherComp, {texels(0, links, VK_FORMAT_R32G32_UINT), storage(1, out)}, params,
//             groups);
//         });
//         return out;                                                     // the new version: the only name of the
//         result
//     });
//
// Passes run in the order of their declaration. compile once, execute every frame.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "city/base/result.h"
#include "engine/gpu/recorder.h"
#include "engine/gpu/resources.h"
#include "engine/graph/barriers.h"
#include "engine/graph/use.h"

namespace helio {

class FrameGraph;
class PassContext;

/// Names one version of a buffer or image of one graph. T is Buffer or Image.
template <class T> struct Ref
{
    u32 index = kNoIndex;
    u32 version = 0;

    bool valid() const { return index != kNoIndex; }
    bool operator==(const Ref&) const = default;
};

/// Declares what one pass does. Lives during setup only.
class PassBuilder
{
public:
    /// A resource of the graph's own: allocated by compile, its contents are undefined until a pass writes them in each
    /// execution. Images may leave `usage` 0: it follows from the declared uses.
    Ref<Buffer> create(BufferDesc desc);
    Ref<Image> create(ImageDesc desc);
    /// A resource that outlives the graph. Same as FrameGraph::import.
    Ref<Buffer> import(const Buffer& buffer);
    Ref<Image> import(const Image& image);

    /// Declares a read of this version and returns it. A pass may declare several uses of one resource (for images: of
    /// one layout).
    Ref<Buffer> read(Ref<Buffer> ref, Use use);
    Ref<Image> read(Ref<Image> ref, Use use);
    /// Declares a write and returns the new version; the old one is dead for all later passes.
    [[nodiscard]] Ref<Buffer> write(Ref<Buffer> ref, Use use);
    [[nodiscard]] Ref<Image> write(Ref<Image> ref, Use use);

    /// Keeps the pass even if nobody reads what it writes. Writes to imported resources keep their pass anyway.
    void sideEffect();
    /// What the pass records at every execution. Capture by value: setup's locals are gone by then.
    void record(std::function<void(PassContext&)> body);

private:
    friend class FrameGraph;
    PassBuilder(FrameGraph& graph, u32 pass) : graph_(graph), pass_(pass) {}

    FrameGraph& graph_;
    u32 pass_;
};

/// What compile found out, without any device.
struct GraphPlan
{
    std::vector<u32> passes;                    // the live ones, in order
    std::vector<std::vector<Access>> accesses;  // of each live pass, then of the final uses (leave)
    std::vector<VkImageUsageFlags> imageUsages; // of each resource; 0 for buffers
};

class FrameGraph
{
public:
    explicit FrameGraph(std::string name = "frame");
    /// Frees the graph's own resources: wait for the recorders that executed it first.
    ~FrameGraph();
    FrameGraph(FrameGraph&&) noexcept;
    FrameGraph& operator=(FrameGraph&&) noexcept;

    /// Adds a pass: calls setup(PassBuilder&) at once and returns what it returns.
    template <class Setup> auto addPass(std::string name, Setup&& setup)
    {
        PassBuilder builder(*this, openPass(std::move(name)));
        return std::forward<Setup>(setup)(builder);
    }

    /// A resource that outlives the graph (and must). Its last access is kept with the resource, so several graphs may
    /// use it in turn. Importing it again names its newest version.
    Ref<Buffer> import(const Buffer& buffer);
    Ref<Image> import(const Image& image);
    /// Replaces an imported resource by another of the same description (a swapchain image), between executions.
    void rebind(Ref<Image> imported, const Image& image);

    /// After the last pass, brings a resource into a state for use outside: HostRead, Present, or any read.
    void leave(Ref<Buffer> ref, Use use);
    void leave(Ref<Image> ref, Use use);

    /// Checks the declarations and culls what nobody needs; no device. Errors, each a sentence with pass and resource:
    /// reading what nobody wrote, using a version that a later one replaced, two writers of one version, a reference of
    /// another graph, one image in two layouts in one pass, a use that does not fit the resource, a pass without
    /// record.
    Result<GraphPlan> plan() const;
    /// plan, then allocates the graph's own resources.
    Status compile(Context& context);
    /// Records all live passes with their barriers. compile must have succeeded. With `timings`, each pass gets a mark
    /// by its name (Recorder::times), and passes do not overlap.
    void execute(Recorder& recorder, bool timings = false);

    /// After compile: the resource behind a reference (to download a result, for example).
    const Buffer& buffer(Ref<Buffer> ref) const;
    const Image& image(Ref<Image> ref) const;

    /// Graph in DOT: passes (dashed if culled) with, once compiled, what they wait for; resource versions with their
    /// sizes; uses. For --dump-graph and bug reports.
    std::string dump() const;

private:
    friend class PassBuilder;
    friend class PassContext;
    struct Impl;
    u32 openPass(std::string name);

    std::unique_ptr<Impl> impl_;
};

} // namespace helio
