// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "city/base/types.h"

namespace helio {

/// The upper hemisphere in cells of equal solid angle: rings of equal-height cells around a cap, as square as whole
/// numbers allow (after B. and P. Beckers, "A general rule for disk and hemisphere partition into equal-area cells",
/// Computational Geometry 45, 2012). Cells count from the zenith down, in a ring counter-clockwise from +x. A dome of
/// one cell is the hemisphere itself; one of 145 has cells like Tregenza's sky patches.
class SkyDome
{
public:
    /// Number of cells, 1 to kMaxCells.
    explicit SkyDome(u32 cells);

    static constexpr u32 kMaxCells = 4096;

    u32 cellCount() const { return firstOfRing_.back(); }
    double solidAngle() const; ///< of every cell, sr

    /// The cell that an upward direction lies in; `direction` is a unit vector with z > 0.
    u32 cellOf(const glm::dvec3& direction) const;

    /// Unit vector to the point of a cell at (u, v) in [0, 1]: v parts the cell's area in height, u in azimuth; (0.5,
    /// 0.5) is its centre.
    glm::dvec3 pointOf(u32 cell, double u, double v) const;

    /// Unit vector to a cell's centre; the zenith for the cap.
    glm::dvec3 centreOf(u32 cell) const;

    /// Where in its cell an upward direction lies, in [-0.5, 0.5]: azimuth and height, downwards, in equal areas; in
    /// the cap, whose azimuth says nothing, its x and y over the cap's width.
    glm::dvec2 placeIn(u32 cell, const glm::dvec3& direction) const;

    struct Place
    {
        u32 cell = 0;
        glm::dvec2 inside{0.0};
    };
    /// cellOf() and placeIn() at once.
    Place placeOf(const glm::dvec3& direction) const;

    /// Integral of the cosine to the zenith over a cell, sr. They sum to pi.
    double projectedSolidAngle(u32 cell) const;

    /// Integral over a cell of the cosine to the zenith times the second coordinate of placeIn, sr; with the first it
    /// is 0.
    double projectedHeight(u32 cell) const;

private:
    u32 ringOf(u32 cell) const;
    u32 cellAt(double turn, double z) const; ///< turn of the azimuth in [0, 1]
    glm::dvec2 placeAt(u32 cell, double turn, const glm::dvec3& direction) const;
    double cosineAbove(u32 ring) const; ///< of the zenith angle where a ring begins

    std::vector<u32> firstOfRing_; ///< first cell of each ring, then the number of cells
};

} // namespace helio
