// SPDX-License-Identifier: Apache-2.0
// The inside of FrameGraph, shared by its source files only.
#pragma once
#include "engine/graph/frame_graph.h"

namespace helio {

struct FrameGraph::Impl
{
    /// One declared use. A read names the version it reads, a write the version it makes.
    struct Declared
    {
        u32 resource;
        u32 version;
        Use use;
        bool write;
    };

    struct Pass
    {
        std::string name;
        std::vector<Declared> uses;
        bool sideEffect = false;
        std::function<void(PassContext&)> body;
    };

    struct Resource
    {
        std::string name;
        bool image = false;
        bool imported = false;
        BufferDesc bufferDesc;
        ImageDesc imageDesc;
        const Buffer* buffer = nullptr; // imported, or &ownBuffer after compile
        const Image* texture = nullptr;
        std::vector<u32> writers; // writers[v] = pass that made version v; version 0 has kNoIndex

        u32 newestVersion() const { return u32(writers.size()) - 1; }
        AccessState& state() const { return image ? texture->state() : buffer->state(); }
    };

    std::string name;
    std::vector<Pass> passes;
    std::vector<Resource> resources;
    std::vector<Declared> finals;      // uses after the last pass
    std::vector<std::string> mistakes; // in the order of declaration; compile reports the first
    std::vector<std::unique_ptr<Buffer>> ownBuffers;
    std::vector<std::unique_ptr<Image>> ownImages;
    std::optional<GraphPlan> compiled;
    std::shared_ptr<const std::string> note; // dump of the compiled graph

    u32 addResource(Resource resource);
    /// False, and a mistake noted, if the reference is not of this graph or not of this kind.
    bool checkRef(u32 index, u32 version, bool image, const std::string& user);
    void declareRead(u32 pass, u32 index, u32 version, bool image, Use use);
    u32 declareWrite(u32 pass, u32 index, u32 version, bool image, Use use); // the new version
    void declareFinal(u32 index, u32 version, bool image, Use use);
    bool fits(Use use, u32 index, const std::string& user); // notes a mistake if not
    std::vector<bool> livePasses() const;
    Result<std::vector<Access>> accessesOf(const std::vector<Declared>& uses, const std::string& user,
                                           std::vector<bool>& touched) const;
    Result<GraphPlan> makePlan() const;
};

} // namespace helio
