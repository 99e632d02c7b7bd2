// SPDX-License-Identifier: Apache-2.0
#include "city/layout/obj_faces.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace helio {

namespace {

constexpr double kOffPlane = 1e-3; // of the face's size
constexpr double kNoArea = 1e-12;  // of the square of the face's size

// Why a ring cannot be a surface; empty if it can.
std::string faultOf(const Ring3& ring)
{
    glm::dvec3 low = ring[0], high = ring[0], middle(0.0);
    for (const glm::dvec3& corner : ring) {
        low = glm::min(low, corner);
        high = glm::max(high, corner);
        middle += corner / double(ring.size());
    }
    const double size = glm::length(high - low);
    const glm::dvec3 areaVector = vectorArea(ring);
    const double area = glm::length(areaVector);
    if (area <= kNoArea * size * size) return "face without area";
    double far = 0.0;
    for (const glm::dvec3& corner : ring) far = std::max(far, std::abs(glm::dot(corner - middle, areaVector)) / area);
    if (far <= kOffPlane * size) return {};
    return concat("face is not planar: a corner lies ", far, " m off its plane; split it into triangles");
}

} // namespace

std::string_view takeLine(std::string_view& text)
{
    const size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
}

std::string_view takeWord(std::string_view& text)
{
    const size_t begin = std::min(text.find_first_not_of(" \t"), text.size());
    text.remove_prefix(begin);
    const size_t end = std::min(text.find_first_of(" \t"), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(end);
    return word;
}

bool parseNumber(std::string_view text, double& number)
{
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1); // from_chars takes no plus sign
    const char* end = text.data() + text.size();
    const auto [stop, failure] = std::from_chars(text.data(), end, number);
    return failure == std::errc() && stop == end && std::isfinite(number);
}

bool parseInteger(std::string_view text, i64& number)
{
    const char* end = text.data() + text.size();
    const auto [stop, failure] = std::from_chars(text.data(), end, number);
    return failure == std::errc() && stop == end;
}

Result<std::vector<ObjFace>> readObjFaces(std::string_view text, std::string_view name)
{
    std::vector<glm::dvec3> vertices;
    std::vector<ObjFace> faces;
    u32 lineNumber = 0;
    const auto fail = [&](const std::string& what) { return Error{concat(name, ":", lineNumber, ": ", what)}; };
    while (!text.empty()) {
        std::string_view line = takeLine(text);
        ++lineNumber;
        const std::string_view keyword = takeWord(line);
        if (keyword == "v") {
            glm::dvec3 vertex(0.0);
            for (int i = 0; i < 3; ++i) {
                const std::string_view word = takeWord(line);
                if (!parseNumber(word, vertex[i])) return fail(concat("coordinate \"", word, "\" is not a number"));
            }
            vertices.push_back(vertex);
        } else if (keyword == "f") {
            ObjFace face;
            face.line = lineNumber;
            for (std::string_view word = takeWord(line); !word.empty(); word = takeWord(line)) {
                i64 index = 0;
                if (!parseInteger(word.substr(0, word.find('/')), index))
                    return fail(concat("corner \"", word, "\" is not a vertex index"));
                const i64 count = i64(vertices.size());
                const i64 place = index > 0 ? index - 1 : count + index;
                if (index == 0 || place < 0 || place >= count)
                    return fail(concat("vertex ", index, " does not exist; ", count, " were read so far"));
                face.ring.push_back(vertices[size_t(place)]);
            }
            if (face.ring.size() < 3) return fail(concat("face with ", face.ring.size(), " corners; 3 are needed"));
            if (const std::string fault = faultOf(face.ring); !fault.empty()) return fail(fault);
            faces.push_back(std::move(face));
        }
    }
    return faces;
}

} // namespace helio
