// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/gather_cases.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/packing.hpp>

#include "bench_shaders/embedded.h"
#include "city/base/hash.h"
#include "city/base/parallel.h"
#include "engine/gpu/transfer.h"
#include "engine/graph/pass_context.h"
#include "engine/stages/gather.h"
#include "shaders/embedded.h"

namespace helio {

namespace {

using Float4 = float __attribute__((vector_size(16)));

constexpr u32 kSweeps = 3; // of one repetition
constexpr u32 kThreads = 2;

const ReadVariants kRandomGather{shaders::kRandomGatherComp, shaders::kRandomGatherImagesComp,
                                 shaders::kRandomGatherStorageComp};

struct Rows
{
    u32 rowCount = 0, length = 0;
    bool linear = false;
    std::vector<u32> rows, columns;
    std::vector<float> factors, moments;
};

Rows makeRows(u32 rowCount, u32 length, bool linear)
{
    Rows r{rowCount, length, linear, {}, {}, {}, {}};
    Random random(17);
    for (u32 i = 0; i <= rowCount; ++i) r.rows.push_back(i * length);
    for (u32 i = 0; i < rowCount; ++i)
        for (u32 k = 0; k < length; ++k) {
            const i64 reach = random.uniform() < 0.9 ? 2000 : 32000;
            const i64 column = i64(i) + i64((2.0 * random.uniform() - 1.0) * double(reach));
            r.columns.push_back(u32(std::clamp<i64>(column, 0, rowCount - 1)));
            r.factors.push_back(float(random.uniform() / length));
            if (!linear) continue;
            r.moments.push_back(r.factors.back() * float(2.0 * random.uniform() - 1.0));
            r.moments.push_back(r.factors.back() * float(2.0 * random.uniform() - 1.0));
        }
    return r;
}

/// One case's links in all forms, on the device and for the host.
struct Problem
{
    Rows rows;
    PackedLinks packed;
    LinkBuffers links;
    Buffer senders, irradiance, plainRows, plainColumns, plainFactors, plainMoments, plainRadiosity, plainSlopes;
    std::vector<Float4> hostSenders, hostIrradiance;
};

/// Linear senders are all inner nodes, constant ones all patches.
std::shared_ptr<Problem> makeProblem(Context& context, u32 rowCount, u32 length, bool linear)
{
    auto p = std::make_shared<Problem>();
    p->rows = makeRows(rowCount, length, linear);
    const LinkRows view{p->rows.rows, p->rows.columns, p->rows.factors, p->rows.moments, linear ? 0 : rowCount};
    const RowLevel all{0, rowCount};
    p->packed = std::move(*packLinks(view, {&all, 1}, {}));
    p->links = uploadLinks(context, "links", PackedLinks(p->packed), view);
    std::vector<glm::vec4> senders, plain, slopes;
    const glm::vec4 slope(0.25f, 0.125f, -0.25f, 0.5f);
    const u32 half = glm::packHalf2x16({slope.x, slope.y}), other = glm::packHalf2x16({slope.z, slope.w});
    Random random(3);
    for (u32 i = 0; i < rowCount; ++i) {
        plain.emplace_back(float(random.uniform()));
        senders.push_back(plain.back());
        if (!linear) continue;
        senders.push_back(std::bit_cast<glm::vec4>(glm::uvec4(half, other, half, other)));
        slopes.push_back(plain.back() * slope);
        slopes.push_back(plain.back() * slope);
    }
    p->senders = makeBuffer(context, "senders", senders);
    p->irradiance = makeBuffer(context, "irradiance", plain);
    p->plainRows = makeBuffer(context, "rows", p->rows.rows);
    p->plainColumns = makeBuffer(context, "columns", p->rows.columns);
    p->plainFactors = makeBuffer(context, "factors", p->rows.factors);
    p->plainRadiosity = makeBuffer(context, "radiosity", plain);
    if (linear) {
        p->plainMoments = makeBuffer(context, "moments", p->rows.moments);
        p->plainSlopes = makeBuffer(context, "slopes", slopes);
    }
    for (const glm::vec4& s : senders) p->hostSenders.push_back(Float4{s.x, s.y, s.z, s.w});
    p->hostIrradiance.resize(rowCount);
    return p;
}

void addNaive(FrameGraph& graph, const Problem& p)
{
    struct Params
    {
        u32 rowFirst, rowCount;
    };
    Ref<Buffer> irradiance = graph.import(p.irradiance);
    for (u32 n = 0; n < kSweeps; ++n)
        irradiance = graph.addPass("gather", [&](PassBuilder& pass) {
            const auto read = [&](const Buffer& buffer) { return pass.read(pass.import(buffer), Use::ComputeRead); };
            const auto rows = read(p.plainRows), columns = read(p.plainColumns), factors = read(p.plainFactors),
                       radiosity = read(p.plainRadiosity);
            const Ref<Buffer> moments = p.rows.linear ? read(p.plainMoments) : Ref<Buffer>{};
            const Ref<Buffer> slopes = p.rows.linear ? read(p.plainSlopes) : Ref<Buffer>{};
            const auto out = pass.write(irradiance, Use::ComputeWrite);
            pass.record([=, count = p.rows.rowCount, length = p.rows.length, linear = p.rows.linear](PassContext& ctx) {
                // The moments of a million rows are more than one binding may hold: halves.
                for (u32 part = 0; part < (linear ? 2u : 1u); ++part) {
                    const Params params{part * (count / 2), linear ? count / 2 : count};
                    std::vector<Binding> bindings{storage(0, rows), storage(1, columns), storage(2, factors),
                                                  storage(3, radiosity), storage(4, out)};
                    const u64 bytes = u64(count / 2) * length * 8;
                    if (linear) {
                        bindings.push_back(storage(5, moments, part * bytes, bytes));
                        bindings.push_back(storage(6, slopes));
                    }
                    ctx.dispatchBytes(linear ? bench_shaders::kGatherNaiveLinearComp : bench_shaders::kGatherNaiveComp,
                                      bindings, std::as_bytes(std::span(&params, 1)),
                                      groupsFor(params.rowCount, gpu::kSolveGroup), {});
                }
            });
            return out;
        });
}

/// The same packed links, strip by strip, in vector types.
void gatherOnHost(Problem& p)
{
    const PackedLinks& packed = p.packed;
    const u32 factorBits = packed.factorBits, shift = gpu::kMaxFactorBits - factorBits;
    const auto factorOf = [shift](u32 link) {
        return gpu::kFactorScale * std::bit_cast<float>((link << shift) & ((1u << gpu::kMaxFactorBits) - 1u));
    };
    const auto halfOf = [](u32 word) { return glm::unpackHalf2x16(word); };
    parallelFor(u32(packed.strips.size()), 256, kThreads, [&](u32 begin, u32 end) {
        for (u32 s = begin; s < end; ++s)
            for (u32 r = 0; r < gpu::kStripRows; ++r) {
                const gpu::StripRecord& strip = packed.strips[s];
                Float4 sum{};
                u32 at = strip.begin + r, momentAt = strip.momentBegin + r;
                for (u32 n = 0; n < strip.patchRecords; ++n, at += gpu::kStripRows) {
                    const gpu::LinkQuadRecord& quad = packed.records[at];
                    for (const u32 link : {quad.link0, quad.link1, quad.link2, quad.link3})
                        sum += factorOf(link) * p.hostSenders[link >> factorBits];
                }
                for (u32 n = 0; n < strip.innerRecords; ++n, at += gpu::kStripRows, momentAt += gpu::kStripRows) {
                    const gpu::LinkQuadRecord& quad = packed.records[at];
                    const gpu::MomentQuadRecord& moments = packed.moments[momentAt];
                    const auto add = [&](u32 link, u32 moment) {
                        const Float4* const sender = &p.hostSenders[2 * (link >> factorBits)];
                        const float x = float(std::int8_t(moment & 255)) * (gpu::kMomentLimit / 127.0f);
                        const float y = float(std::int8_t(moment >> 8 & 255)) * (gpu::kMomentLimit / 127.0f);
                        const glm::uvec4 words = std::bit_cast<glm::uvec4>(sender[1]);
                        const glm::vec2 a = x * halfOf(words.x) + y * halfOf(words.z);
                        const glm::vec2 b = x * halfOf(words.y) + y * halfOf(words.w);
                        sum += factorOf(link) * (sender[0] + sender[0] * Float4{a.x, a.y, b.x, b.y});
                    };
                    add(quad.link0, moments.moments01);
                    add(quad.link1, moments.moments01 >> 16);
                    add(quad.link2, moments.moments23);
                    add(quad.link3, moments.moments23 >> 16);
                }
                const u32 receiver = packed.rows[s * gpu::kStripRows + r].receiver;
                if (receiver != kNoIndex) p.hostIrradiance[receiver] = sum;
            }
    });
}

/// Packed and plain on the device and packed on the host say the same, rounding aside.
void expectAgreement(Context& context, Problem& p, const std::string& name)
{
    const auto run = [&](const std::function<void(FrameGraph&)>& build) {
        FrameGraph graph("check");
        build(graph);
        Recorder recorder(context);
        runGraph(context, recorder, graph);
        return downloadItems<glm::vec4>(context, p.irradiance);
    };
    const auto plain = run([&](FrameGraph& graph) { addNaive(graph, p); });
    const auto packed = run([&](FrameGraph& graph) {
        (void)addGather(graph, p.links, graph.import(p.senders), graph.import(p.irradiance),
                        {"gather", 1.0f, Reads::Storage});
    });
    gatherOnHost(p);
    for (size_t i = 0; i < plain.size(); ++i) {
        const float limit = 0.02f * std::abs(plain[i].x) + 1e-3f;
        HELIO_CHECK(std::abs(packed[i].x - plain[i].x) <= limit &&
                        std::abs(p.hostIrradiance[i][0] - plain[i].x) <= limit,
                    name, ": row ", i, " is ", plain[i].x, ", packed ", packed[i].x, ", host ", p.hostIrradiance[i][0]);
    }
}

void addRows(CaseList& cases, const std::string& title, u32 rowCount, u32 length, bool linear)
{
    const std::string packed = "gather " + title, naive = packed + ", plain storage", host = packed + ", host";
    if (!cases.wants(packed) && !cases.wants(naive) && !cases.wants(host)) return;
    Problem& p = cases.keep(makeProblem(cases.context(), rowCount, length, linear));
    const Reads reads = fastestReads(cases.context(), u64(rowCount) * p.links.stride);
    const double moved = kSweeps * (double(p.links.bytes) + rowCount * (8.0 + 16.0 + 16.0 * p.links.stride));
    cases.addGraph(
        packed,
        [&](FrameGraph& graph) {
            Ref<Buffer> out = graph.import(p.irradiance);
            for (u32 n = 0; n < kSweeps; ++n)
                out = addGather(graph, p.links, graph.import(p.senders), out, {"gather", 1.0f, reads});
        },
        "gather", moved);
    cases.addGraph(
        naive, [&](FrameGraph& graph) { addNaive(graph, p); }, "gather");
    expectAgreement(cases.context(), p, packed);
    cases.addWall(host, [&](CaseList::Figures& figures) {
        for (u32 n = 0; n < kSweeps; ++n) gatherOnHost(p);
        figures["bytes a link"] = double(p.links.bytes) / double(p.links.linkCount);
    });
    cases.addRatio({packed + " over plain storage", naive, packed});
    cases.addRatio({packed + ": two threads of the host over it", packed, host});
}

void addRooflines(CaseList& cases)
{
    struct Tables
    {
        Buffer from, to, sums;
    };
    const u64 bytes = u64(cases.options().copyMiB) << 20;
    Context& context = cases.context();
    auto made = std::make_shared<Tables>();
    made->from = makeBuffer(context, "copy source", std::vector<u32>(bytes / 4));
    made->to = Buffer(context, {"copy target", bytes});
    Tables& t = cases.keep(made);
    cases.addGraph(
        "stream copy",
        [&](FrameGraph& graph) {
            graph.addPass("stream copy", [&](PassBuilder& pass) {
                const auto from = pass.read(pass.import(t.from), Use::CopyFrom);
                const auto to = pass.write(pass.import(t.to), Use::CopyTo);
                pass.record([=](PassContext& ctx) { ctx.copy(from, to); });
            });
        },
        "stream copy", 2.0 * double(bytes));
    constexpr u32 kGroups = 1024, kLoads = 64;
    t.sums = Buffer(context, {"sums", u64(kGroups) * 64 * 16});
    for (const u32 kib : {64u, 1024u, 8192u, 65536u}) {
        const std::string title = concat("random loads of 16 bytes, ", kib, " KiB");
        if (!cases.wants(title)) continue;
        auto table = std::make_shared<Buffer>(makeBuffer(context, "table", std::vector<glm::vec4>(kib * 64)));
        const Buffer& values = cases.keep(table);
        const Reads reads = fastestReads(context, kib * 64);
        cases.addGraph(
            title,
            [&](FrameGraph& graph) {
                graph.addPass("loads", [&](PassBuilder& pass) {
                    const auto from = pass.read(pass.import(values), Use::ComputeRead);
                    const auto to = pass.write(pass.import(t.sums), Use::ComputeWrite);
                    pass.record([=](PassContext& ctx) {
                        ctx.dispatch(kRandomGather[reads],
                                     {texels(0, from, VK_FORMAT_R32G32B32A32_SFLOAT), storage(1, to)}, kib * 64 - 1,
                                     Groups{kGroups, 1, 1});
                    });
                });
            },
            "loads", 16.0 * kGroups * 64 * kLoads);
    }
}

} // namespace

void addGatherCases(CaseList& cases)
{
    addRooflines(cases);
    addRows(cases, "250k x 64", 250000, 64, false);
    addRows(cases, "1M x 16", 1000000, 16, false);
    addRows(cases, "1M x 24, linear", 1000000, 24, true);
}

} // namespace helio
