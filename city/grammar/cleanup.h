// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/grammar/geometry.h"

namespace helio::cga {

/// Merges and removes what a surface does not need (`what`: kCleanVertices, kCleanEdges, kCleanFaces of program.h):
/// corners closer than `tolerance` metres become one, corners at which no face turns by more than 10 * `tolerance`
/// degrees go; edges between faces whose normals differ by no more than that go, where the faces then have one outline;
/// faces of at most `tolerance` m2 and faces that are there twice go (of a closed solid only those without area).
/// tolerance: 0..1; 0 takes away only what changes nothing. Time: corners squared.
Geometry cleaned(const Geometry& geometry, u32 what, double tolerance);

} // namespace helio::cga
