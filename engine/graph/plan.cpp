// SPDX-License-Identifier: Apache-2.0
// The checks of a frame graph and what follows from its declarations, without any device.
#include <algorithm>

#include "engine/graph/frame_graph_impl.h"

namespace helio {

u32 FrameGraph::Impl::addResource(Resource resource)
{
    resource.writers = {kNoIndex};
    resources.push_back(std::move(resource));
    return u32(resources.size()) - 1;
}

bool FrameGraph::Impl::checkRef(u32 index, u32 version, bool image, const std::string& user)
{
    if (index >= resources.size() || resources[index].image != image || version > resources[index].newestVersion()) {
        mistakes.push_back(concat(user, " uses a reference that graph '", name, "' did not make"));
        return false;
    }
    return true;
}

bool FrameGraph::Impl::fits(Use use, u32 index, const std::string& user)
{
    const UseInfo& info = useInfo(use);
    const bool image = resources[index].image;
    if (image ? info.layout != VK_IMAGE_LAYOUT_UNDEFINED : info.buffers) return true;
    mistakes.push_back(concat(user, " uses ", image ? "image '" : "buffer '", resources[index].name, "' as ", info.name,
                              ", which is no use of ", image ? "an image" : "a buffer"));
    return false;
}

void FrameGraph::Impl::declareRead(u32 pass, u32 index, u32 version, bool image, Use use)
{
    const std::string user = concat("pass '", passes[pass].name, "'");
    if (!checkRef(index, version, image, user) || !fits(use, index, user)) return;
    const Resource& resource = resources[index];
    if (useInfo(use).isWrite()) {
        mistakes.push_back(concat(user, " reads '", resource.name, "' with the use ", useInfo(use).name,
                                  ", which writes: declare it with write"));
    } else if (version != resource.newestVersion()) {
        mistakes.push_back(concat(user, " reads version ", version, " of '", resource.name, "', which pass '",
                                  passes[resource.writers[version + 1]].name, "' replaced by version ", version + 1,
                                  ": use the reference that write returned"));
    } else if (version == 0 && !resource.imported) {
        mistakes.push_back(concat(user, " reads '", resource.name, "', which no pass has written"));
    } else {
        passes[pass].uses.push_back({index, version, use, false});
    }
}

u32 FrameGraph::Impl::declareWrite(u32 pass, u32 index, u32 version, bool image, Use use)
{
    const std::string user = concat("pass '", passes[pass].name, "'");
    if (!checkRef(index, version, image, user) || !fits(use, index, user)) return version;
    Resource& resource = resources[index];
    if (!useInfo(use).isWrite()) {
        mistakes.push_back(concat(user, " writes '", resource.name, "' with the use ", useInfo(use).name,
                                  ", which only reads: declare it with read"));
    } else if (version != resource.newestVersion()) {
        mistakes.push_back(concat("pass '", passes[resource.writers[version + 1]].name, "' and ", user,
                                  " both write version ", version, " of '", resource.name,
                                  "': use the reference that the first write returned"));
    } else if (version == 0 && !resource.imported && useInfo(use).needsContents) {
        mistakes.push_back(concat(user, " uses '", resource.name, "' as ", useInfo(use).name,
                                  ", which reads it first, but no pass has written it"));
    } else {
        resource.writers.push_back(pass);
        passes[pass].uses.push_back({index, version + 1, use, true});
        return version + 1;
    }
    return version;
}

void FrameGraph::Impl::declareFinal(u32 index, u32 version, bool image, Use use)
{
    const std::string user = "the end of the graph";
    if (!checkRef(index, version, image, user) || !fits(use, index, user)) return;
    const Resource& resource = resources[index];
    if (useInfo(use).isWrite()) {
        mistakes.push_back(concat(user, " leaves '", resource.name, "' for ", useInfo(use).name, ", which writes"));
    } else {
        finals.push_back({index, version, use, false});
    }
}

std::vector<bool> FrameGraph::Impl::livePasses() const
{
    std::vector<bool> live(passes.size(), false);
    // Passes only use versions of earlier passes, so one sweep from the back sees every need before its writer.
    const auto need = [&](u32 resource, u32 version) {
        const u32 writer = resources[resource].writers[version];
        if (writer != kNoIndex) live[writer] = true;
    };
    for (const Declared& use : finals) need(use.resource, use.version);
    for (size_t i = passes.size(); i-- > 0;) {
        const Pass& pass = passes[i];
        const auto visible = [&](const Declared& use) { return use.write && resources[use.resource].imported; };
        if (pass.sideEffect || std::any_of(pass.uses.begin(), pass.uses.end(), visible)) live[i] = true;
        if (!live[i]) continue;
        // A write adds to the version before it, whose writer is therefore needed too.
        for (const Declared& use : pass.uses) need(use.resource, use.write ? use.version - 1 : use.version);
    }
    return live;
}

Result<std::vector<Access>> FrameGraph::Impl::accessesOf(const std::vector<Declared>& uses, const std::string& user,
                                                         std::vector<bool>& touched) const
{
    std::vector<Access> accesses;
    for (const Declared& use : uses) {
        Access access = accessOf(use.resource, resources[use.resource].image, use.use);
        const auto same = [&](const Access& other) { return other.resource == use.resource; };
        const auto known = std::find_if(accesses.begin(), accesses.end(), same);
        if (known != accesses.end()) {
            if (!mergeAccess(*known, access)) {
                return Error{concat(user, " uses image '", resources[use.resource].name,
                                    "' in two layouts at once; the second is ", useInfo(use.use).name,
                                    ": split the pass")};
            }
            continue;
        }
        // The graph's own resources start each execution empty: their first layout may discard what was there.
        access.keepContents = resources[use.resource].imported || touched[use.resource];
        touched[use.resource] = true;
        accesses.push_back(access);
    }
    return accesses;
}

Result<GraphPlan> FrameGraph::Impl::makePlan() const
{
    if (!mistakes.empty()) return Error{mistakes[0]};
    for (const Pass& pass : passes) {
        if (!pass.body) return Error{concat("pass '", pass.name, "' has no record function")};
    }
    GraphPlan plan;
    plan.imageUsages.assign(resources.size(), 0);
    std::vector<bool> touched(resources.size(), false);
    const std::vector<bool> live = livePasses();
    for (u32 i = 0; i < passes.size(); ++i) {
        if (!live[i]) continue;
        Result<std::vector<Access>> accesses =
            accessesOf(passes[i].uses, concat("pass '", passes[i].name, "'"), touched);
        if (!accesses) return accesses.error();
        plan.passes.push_back(i);
        plan.accesses.push_back(std::move(*accesses));
        for (const Declared& use : passes[i].uses) plan.imageUsages[use.resource] |= useInfo(use.use).imageUsage;
    }
    Result<std::vector<Access>> last = accessesOf(finals, "the end of the graph", touched);
    if (!last) return last.error();
    plan.accesses.push_back(std::move(*last));
    for (u32 i = 0; i < resources.size(); ++i) {
        const Resource& resource = resources[i];
        if (!touched[i] || resource.imported) continue;
        const bool empty = resource.image ? resource.imageDesc.width == 0 || resource.imageDesc.height == 0
                                          : resource.bufferDesc.bytes == 0;
        if (empty) return Error{concat(resource.image ? "image '" : "buffer '", resource.name, "' has no size")};
    }
    return plan;
}

} // namespace helio
