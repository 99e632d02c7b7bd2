// SPDX-License-Identifier: Apache-2.0
#include "city/light/link_kernel.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>

namespace helio {
namespace {

constexpr u32 kMost = NodeParts::kMost;
// Shares of the worst case that turned out to be typical (scenes S and M of the reference set).
constexpr float kInsidePartError = 0.1f; // of a part's variance: what the parts do not resolve
/// What the errors of a constant receiver count against those of a sender: those of many senders add up, for they have
/// the same sign where a receiver's parts see more of the scene than others.
constexpr float kReceiverWeight = 4.0f;

} // namespace

float partExchange(const NodeParts& a, const NodeParts& b, const glm::vec3& between, const glm::vec3& normalA,
                   const glm::vec3& normalB, PartMatrix& exchange)
{
    constexpr float kTiny = 1e-12f; // m2: keeps the quotient of coincident centroids finite
    // All parts of a node lie in one plane, so a height depends on one of the two parts alone.
    NodeParts::Row aHeight, bHeight;
    const float atA = -glm::dot(normalB, between), atB = glm::dot(normalA, between);
    for (u32 i = 0; i < kMost; ++i) {
        aHeight[i] = std::max(0.0f, atA + normalB.x * a.x[i] + normalB.y * a.y[i] + normalB.z * a.z[i]) * a.area[i];
        bHeight[i] = std::max(0.0f, atB + normalA.x * b.x[i] + normalA.y * b.y[i] + normalA.z * b.z[i]) * b.area[i];
    }
    float total = 0.0f;
    for (u32 i = 0; i < kMost; ++i) {
        const float x = between.x - a.x[i], y = between.y - a.y[i], z = between.z - a.z[i];
        float sum = 0.0f;
        for (u32 j = 0; j < kMost; ++j) {
            const float dx = x + b.x[j], dy = y + b.y[j], dz = z + b.z[j];
            const float d2 = dx * dx + dy * dy + dz * dz + kTiny;
            const float larger = std::max(a.area[i], b.area[j]);
            exchange[i][j] = aHeight[i] * bHeight[j] / (d2 * (std::numbers::pi_v<float> * d2 + larger));
        }
        for (u32 j = 0; j < kMost; ++j) sum += exchange[i][j];
        total += sum;
    }
    return total;
}

PartMatrix transposed(const PartMatrix& matrix)
{
    PartMatrix result;
    for (u32 i = 0; i < kMost; ++i)
        for (u32 j = 0; j < kMost; ++j) result[j][i] = matrix[i][j];
    return result;
}

LinkError linkError(const NodeParts& receiver, const NodeParts& sender, const PartMatrix& exchange,
                    const PartMatrix& open, float distance, float power, float slopePower)
{
    LinkError e;
    // How much the variance inside each part of the sender counts: with the square of its size over the distance.
    NodeParts::Row near;
    for (u32 j = 0; j < kMost; ++j) {
        const float ratio = sender.radius[j] / std::max(distance, sender.radius[j] + 1e-6f);
        near[j] = kInsidePartError * sender.inside[j];
        near[j] *= ratio * ratio;
    }
    NodeParts::Row received{}, momentX{}, momentY{};
    float total = 0.0f, area = 0.0f;
    for (u32 i = 0; i < receiver.count; ++i) {
        const NodeParts::Row& g = exchange[i];
        NodeParts::Row squares{};
        for (u32 j = 0; j < kMost; ++j) {
            const float mixed = open[i][j] * (1.0f - open[i][j]);
            squares[j] = g[j] * g[j] * (near[j] + kInsidePartError * sender.inside[j] * mixed);
        }
        // Quadratic form of the deviations.
        for (u32 k = 0; k < sender.count; ++k) {
            const NodeParts::Row& row = sender.deviation[k];
            const float gk = g[k];
            for (u32 j = 0; j < kMost; ++j) squares[j] += gk * row[j] * g[j];
        }
        float sum = 0.0f, x = 0.0f, y = 0.0f, error = 0.0f;
        for (u32 j = 0; j < kMost; ++j) {
            sum += g[j];
            x += g[j] * sender.slopeX[j];
            y += g[j] * sender.slopeY[j];
            error += squares[j];
        }
        received[i] = sum;
        momentX[i] = x;
        momentY[i] = y;
        total += sum;
        area += receiver.area[i];
        e.momentX += x;
        e.momentY += y;
        e.sender += receiver.errorWeight[i] * std::max(0.0f, error);
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
