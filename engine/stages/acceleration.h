// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec4.hpp>
#include <span>
#include <string>

#include "engine/stream/contraction.h"

namespace helio {

/// Between what lies the largest eigenvalue of a sweep, X -> rho F X, a channel: the rate at which plain sweeps
/// converge in the end.
struct SpectralBounds
{
    glm::dvec4 lower{0.0}, upper{0.0};
};

/// Bounds from one step of the power iteration, radiosities of the patches before and after a sweep without first
/// light. lower: the Rayleigh quotient in the inner product sum A X Y / rho, in which reciprocity (A_i F_ij = A_j F_ji)
/// makes the sweep symmetric. upper: the largest ratio of a patch (Collatz and Wielandt; holds where no factor is
/// negative).
/// reflectance, planes: a patch each, see TileTables.
SpectralBounds spectralBounds(std::span<const glm::vec4> reflectance, std::span<const glm::vec4> planes,
                              std::span<const glm::vec4> before, std::span<const glm::vec4> after);

/// What to tell a user of links that do not contract in the maximum norm; empty if they do. Error bounds need that; the
/// sweeps converge if the eigenvalues are below 1.
std::string contractionNote(const Contraction& contraction, const SpectralBounds& spectrum);

/// Radius m of the interval [-m, m] of eigenvalues that Chebyshev's semi-iteration is laid out for, a channel; 0 =
/// plain sweeps. It is taken where it pays: where the rate of plain sweeps is at least a half, and its own, m / (1 +
/// sqrt(1 - m^2)), does in two sweeps what they do in three. contraction: Contraction::number.
glm::dvec4 chebyshevRadius(const SpectralBounds& spectrum, const glm::dvec4& contraction);

/// The weight of sweep `sweep` (0, 1, 2, ...) after that of the sweep before: 1, 1 / (1 - m^2 / 2), 1 / (1 - m^2 w /
/// 4), in B(k+1) = w (B0 + rho F B(k)) + (1 - w) B(k-1) (Golub and Varga, Numerische Mathematik 3, 1961).
glm::dvec4 chebyshevWeight(u32 sweep, const glm::dvec4& before, const glm::dvec4& radius);

} // namespace helio
