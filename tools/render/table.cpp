// SPDX-License-Identifier: Apache-2.0
#include "tools/render/table.h"

#include <array>
#include <cstdio>
#include <vector>

#include "engine/view/patch_values.h"

namespace helio {

namespace {

constexpr std::array<const char*, 4> kQuantities{"E_sun", "E_sky", "E_indirect", "B"};
constexpr std::array<const char*, 4> kChannels{"r", "g", "b", "solar"};

struct Row
{
    u32 building = gpu::kNone;
    double area = 0.0;
    std::array<glm::dvec4, 4> light{}; ///< in the order of kQuantities
    double error = 0.0;                ///< of E_indirect
};

std::vector<Row> patchRows(const TileView& tile, const LightTables& light)
{
    std::vector<Row> rows;
    rows.reserve(tile.patches.size());
    const std::vector<glm::vec4> errors = expectedErrors(tile, light.indirect);
    for (size_t i = 0; i < tile.patches.size(); ++i)
        rows.push_back({tile.patches[i].building,
                        double(tile.patches[i].area),
                        {glm::dvec4(light.sun[i]), glm::dvec4(light.sky[i]), glm::dvec4(light.indirect[i]),
                         glm::dvec4(light.radiosity[i])},
                        errors.empty() ? 0.0 : double(errors[i].x)});
    return rows;
}

std::vector<Row> faceRows(const TileView& tile, const std::vector<Row>& patches, u32 faceCount)
{
    std::vector<Row> faces(faceCount);
    for (size_t i = 0; i < patches.size(); ++i) {
        const u32 face = tile.patches[i].sourceFace;
        if (face >= faceCount) continue;
        faces[face].building = patches[i].building;
        faces[face].area += patches[i].area;
        // The patches of a face were cut from it and err alike.
        faces[face].error += patches[i].area * patches[i].error;
        for (size_t q = 0; q < kQuantities.size(); ++q) faces[face].light[q] += patches[i].area * patches[i].light[q];
    }
    for (Row& face : faces)
        if (face.area > 0.0) {
            face.error /= face.area;
            for (glm::dvec4& value : face.light) value /= face.area;
        }
    return faces;
}

void append(std::string& text, double value)
{
    char buffer[40];
    const int length = std::snprintf(buffer, sizeof(buffer), ",%.9g", value);
    text.append(buffer, size_t(length));
}

} // namespace

Result<std::string> tableText(const Pack& pack, const LightTables& light, TableRows kind, const std::string& note)
{
    const u32 faceCount = pack.index().sourceFaceCount;
    if (kind == TableRows::Face && faceCount == 0)
        return Error{"the pack was not made from an OBJ scene, so it has no faces: use --per patch"};
    std::vector<Row> rows = patchRows(pack.tile(), light);
    if (kind == TableRows::Face) rows = faceRows(pack.tile(), rows, faceCount);

    std::string text = concat("# area in m2, all light in W/m2 (linear r, g, b, broadband solar); ", note, "\n");
    text += kind == TableRows::Face ? "face,building,area" : "patch,building,area";
    for (const char* quantity : kQuantities)
        for (const char* channel : kChannels) text += concat(",", quantity, "_", channel);
    const bool hasErrors = !pack.tile().patchErrors.empty();
    text += hasErrors ? ",E_indirect_error\n" : "\n";
    for (size_t i = 0; i < rows.size(); ++i) {
        text += concat(i, ",", rows[i].building == gpu::kNone ? i64(-1) : i64(rows[i].building));
        append(text, rows[i].area);
        for (const glm::dvec4& value : rows[i].light)
            for (int c = 0; c < 4; ++c) append(text, value[c]);
        if (hasErrors) append(text, rows[i].error);
        text += "\n";
    }
    return text;
}

} // namespace helio
