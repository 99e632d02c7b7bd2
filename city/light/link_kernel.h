// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/light/node_parts.h"

namespace helio {

/// A value for each pair of parts, receiver by row.
using PartMatrix = std::array<NodeParts::Row, NodeParts::kMost>;

/// Unoccluded exchange of every part of a with every part of b, m2, and their sum: disc formula between the centroids
/// (A_i A_j cos cos / (pi d^2 + larger area)), within a few percent from two sizes on, for judging; links take the
/// exact exchange of the whole. `between`: from the centroid of a to that of b, m; unit normals.
float partExchange(const NodeParts& a, const NodeParts& b, const glm::vec3& between, const glm::vec3& normalA,
                   const glm::vec3& normalB, PartMatrix& exchange);

PartMatrix transposed(const PartMatrix& matrix);

/// What one link from a sender with mean and slope to a receiver with one value gets wrong, as weighted squared errors.
struct LinkError
{
    float momentX = 0.0f, momentY = 0.0f; ///< m2: integral of the exchange x the sender's slope coordinates
    float sender = 0.0f;                  ///< that splitting the sender would remove
    float receiver = 0.0f;                ///< that splitting the receiver would remove
};

/// `exchange`: with occlusion, receiver by row, m2; `power`, `slopePower`: mean over the training lights of the squared
/// radiosity and slope of the sender; `open`: visible share of each pair; `distance` between the centroids, m.
LinkError linkError(const NodeParts& receiver, const NodeParts& sender, const PartMatrix& exchange,
                    const PartMatrix& open, float distance, float power, float slopePower);

} // namespace helio
