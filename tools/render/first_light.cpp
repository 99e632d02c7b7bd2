// SPDX-License-Identifier: Apache-2.0
#include "tools/render/first_light.h"

#include <array>
#include <cmath>

#include "tools/support/light_csv.h"

namespace helio {
namespace {

constexpr double kAreaTolerance = 1e-4;
constexpr double kBrightest = 1e30; // W/m2: beyond it radiosities leave the range of a float

Status readChannel(const LightCsv& csv, const std::string& name, int channel, std::vector<glm::vec4>& to)
{
    const auto column = csv.columns.find(name);
    if (column == csv.columns.end())
        return Error{concat("no column ", name, "; a table of heliopolis-render --table is needed")};
    for (size_t i = 0; i < to.size(); ++i) {
        const double value = column->second[i];
        if (!(value >= 0.0 && value <= kBrightest))
            return Error{concat("patch ", i, ": ", name, " is ", value, "; an irradiance of 0 W/m2 or more is needed")};
        to[i][channel] = float(value);
    }
    return Nothing{};
}

Status checkPatches(const LightCsv& csv, const Pack& pack)
{
    const auto patch = csv.columns.find("patch"), area = csv.columns.find("area");
    if (patch == csv.columns.end() || area == csv.columns.end())
        return Error{"no columns patch and area; a table with a row a patch is needed"};
    if (csv.rows != pack.patchCount())
        return Error{concat(csv.rows, " rows, but the pack has ", pack.patchCount(),
                            " patches: a table of this pack is needed")};
    for (u32 i = 0; i < pack.patchCount(); ++i) {
        const double expected = double(pack.tile().patches[i].area);
        if (patch->second[i] != double(i) || !(std::abs(area->second[i] - expected) <= kAreaTolerance * expected))
            return Error{concat("row ", i, " is patch ", patch->second[i], " of ", area->second[i],
                                " m2, but the pack's patch ", i, " has ", expected,
                                " m2: a table of this pack is needed")};
    }
    return Nothing{};
}

} // namespace

Result<FirstLight> readFirstLight(const std::filesystem::path& path, const Pack& pack)
{
    const Result<LightCsv> csv = readLightCsv(path);
    if (!csv) return csv.error();
    Status status = checkPatches(*csv, pack);
    FirstLight light{std::vector<glm::vec4>(pack.patchCount()), std::vector<glm::vec4>(pack.patchCount())};
    constexpr std::array<const char*, 4> kChannels{"r", "g", "b", "solar"};
    for (int c = 0; c < 4; ++c) {
        if (status) status = readChannel(*csv, concat("E_sun_", kChannels[size_t(c)]), c, light.sun);
        if (status) status = readChannel(*csv, concat("E_sky_", kChannels[size_t(c)]), c, light.sky);
    }
    if (!status) return Error{concat(path.string(), ": ", status.error().message)};
    return light;
}

} // namespace helio
