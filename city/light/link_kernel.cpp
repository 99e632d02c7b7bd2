// SPDX-License-Identifier: Apache-2.0
#include "city/light/link_kernel.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>

#include "city/base/lanes.h"

namespace helio {
namespace {

constexpr u32 kMost = NodeParts::kMost;
// Shares of the worst case that turned out to be typical (scenes S and M of the reference set).
constexpr float kInsidePartError = 0.1f; // of a part's variance: what the parts do not resolve
/// What the errors of a constant receiver count against those of a sender: those of many senders add up, for they have
/// the same sign where a receiver's parts see more of the scene than others.
constexpr float kReceiverWeight = 4.0f;

} // namespace

HELIO_LANES float partExchange(const NodeParts& a, const NodeParts& b, const glm::vec3& between,
                               const glm::vec3& normalA, const glm::vec3& normalB, PartMatrix& exchange)
{
    constexpr float kTiny = 1e-12f; // m2: keeps the quotient of coincident centroids finite
    Float8 ax, ay, az, aArea, bx, by, bz, bArea;
    load(ax, a.x);
    load(ay, a.y);
    load(az, a.z);
    load(aArea, a.area);
    load(bx, b.x);
    load(by, b.y);
    load(bz, b.z);
    load(bArea, b.area);
    // All parts of a node lie in one plane, so a height depends on one of the two parts alone.
    const float atA = -glm::dot(normalB, between), atB = glm::dot(normalA, between);
    const Float8 aHigh = atA + normalB.x * ax + normalB.y * ay + normalB.z * az,
                 bHigh = atB + normalA.x * bx + normalA.y * by + normalA.z * bz, zero{};
    const Float8 aHeight = (aHigh > zero ? aHigh : zero) * aArea, bHeight = (bHigh > zero ? bHigh : zero) * bArea;
    Float8 total{};
    for (u32 i = 0; i < kMost; ++i) {
        const Float8 dx = between.x - ax[i] + bx, dy = between.y - ay[i] + by, dz = between.z - az[i] + bz;
        const Float8 d2 = dx * dx + dy * dy + dz * dz + kTiny, own = zero + aArea[i];
        const Float8 larger = own > bArea ? own : bArea;
        const Float8 row = aHeight[i] * bHeight / (d2 * (std::numbers::pi_v<float> * d2 + larger));
        store(exchange[i], row);
        total += row;
    }
    return sumOf(total);
}

PartMatrix transposed(const PartMatrix& matrix)
{
    PartMatrix result;
    for (u32 i = 0; i < kMost; ++i)
        for (u32 j = 0; j < kMost; ++j) result[j][i] = matrix[i][j];
    return result;
}

HELIO_LANES LinkError linkError(const NodeParts& receiver, const NodeParts& sender, const PartMatrix& exchange,
                                const PartMatrix& open, float distance, float power, float slopePower)
{
    LinkError e;
    Float8 radius, inside, slopeX, slopeY;
    load(radius, sender.radius);
    load(inside, sender.inside);
    load(slopeX, sender.slopeX);
    load(slopeY, sender.slopeY);
    // How much the variance inside each part of the sender counts: with the square of its size over the distance.
    const Float8 least = radius + 1e-6f, far = Float8{} + distance, ratio = radius / (far > least ? far : least);
    inside *= kInsidePartError;
    const Float8 near = inside * ratio * ratio;
    NodeParts::Row received{}, momentX{}, momentY{};
    float total = 0.0f, area = 0.0f;
    for (u32 i = 0; i < receiver.count; ++i) {
        Float8 g, o;
        load(g, exchange[i]);
        load(o, open[i]);
        // Quadratic form of the deviations.
        Float8 form{};
        for (u32 k = 0; k < sender.count; ++k) {
            Float8 row;
            load(row, sender.deviation[k]);
            form += exchange[i][k] * row;
        }
        const Float8 squares = g * (g * (near + inside * (o * (1.0f - o))) + form);
        const float sum = sumOf(g), x = sumOf(g * slopeX), y = sumOf(g * slopeY);
        received[i] = sum;
        momentX[i] = x;
        momentY[i] = y;
        total += sum;
        area += receiver.area[i];
        e.momentX += x;
        e.momentY += y;
        e.sender += receiver.errorWeight[i] * std::max(0.0f, sumOf(squares));
    }
    if (receiver.count < 2) return e;
    const float mean = total / area, meanX = e.momentX / area, meanY = e.momentY / area;
    for (u32 i = 0; i < receiver.count; ++i) {
        const float part = receiver.area[i], d = received[i] - part * mean, x = momentX[i] - part * meanX,
                    y = momentY[i] - part * meanY;
        e.receiver += kReceiverWeight * receiver.errorWeight[i] * (d * d * power + 0.5f * (x * x + y * y) * slopePower);
    }
    return e;
}

} // namespace helio
