// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "city/light/light_tables.h"
#include "city/model/node_tree.h"

namespace helio {

/// How a sweep updates the radiosity. All but the first are the source paper's misprints, kept to show what each costs.
enum class UpdateRule : u8
{
    Repaired,         ///< B = B0 + rho * sum F B_sender
    OwnRadiosity,     ///< second line of the paper's update: the receiver's own B in place of the sender's
    NeverReset,       ///< the paper's "+=" taken literally: B += rho * sum F B
    EnergyAsRadiosity ///< the first B is the energy that arrived (E x area): neither divided by the area nor reflected
};

struct SolveOptions
{
    double residual = 1e-3; ///< stop when a sweep's residual is at most this
    u32 maxSweeps = 100;    ///< stop after this many; also the exact number when `residual` is 0
    UpdateRule rule = UpdateRule::Repaired;
};

/// What one sweep changed.
struct Sweep
{
    /// ||B - B0 - rho F B|| / ||B - B0|| of the radiosity before the sweep, area weighted over patches and channels; B
    /// - B0 is taken after the sweep, so that the first sweep has one too.
    double residual = 0.0;
    /// Rigorous bound of the error of B after the sweep in the maximum norm, W/m2, largest channel: change x q / (1 -
    /// q) with q = the largest rho x row sum, where a link whose weights change sign counts more; infinite if q >= 1.
    double bound = 0.0;
    double paperError = 0.0; ///< the paper's E_i = sqrt(sum over patches (B^i - B^(i-1))^2), largest channel, W/m2
};

struct Solution
{
    std::vector<glm::dvec4> radiosity; ///< per node, W/m2
    std::vector<glm::dvec4> indirect;  ///< per patch: irradiance through all links to it and its ancestors, W/m2
    std::vector<Sweep> sweeps;
};

/// Jacobi sweeps with push-down and pull-up over the hierarchy, in double: gather at every node, irradiance goes down
/// unchanged, flux comes up (B_parent = sum A_c B_c / A_parent). `sun` and `sky` are first-hand irradiance per patch,
/// W/m2. Starts from B0 = emission + rho (E_sun + E_sky).
Solution solveLight(const NodeTree& tree, const LinkTable& links, std::span<const glm::dvec4> sun,
                    std::span<const glm::dvec4> sky, const SolveOptions& options);

/// Sum of the links to each patch and to its ancestors: what the patch sees of a world of radiosity 1.
std::vector<double> patchRowSums(const NodeTree& tree, const LinkTable& links);

/// The patch-to-patch matrix F_ij that the links stand for, row major, patchCount^2: for small scenes in tests.
std::vector<double> denseFactors(const NodeTree& tree, const LinkTable& links);

/// Solves B = b0 + rho F B by elimination with partial pivoting; F row major, n^2.
std::vector<double> solveDense(std::span<const double> factors, std::span<const double> rho,
                               std::span<const double> b0);

} // namespace helio
