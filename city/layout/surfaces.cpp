// SPDX-License-Identifier: Apache-2.0
#include "city/layout/surfaces.h"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

#include "city/base/file.h"
#include "city/layout/obj_faces.h"

namespace helio {

namespace {

// One row of the table, in the order of the columns below.
struct SurfaceRow
{
    std::string kind;
    std::array<i64, 4> path{}; // building, facade, floor, bay
    glm::dvec4 rho{0.0}, emission{0.0};
};

enum Column
{
    kKind,
    kBuilding,
    kFacade,
    kFloor,
    kBay,
    kRho,
    kEmission = kRho + 4,
    kColumnCount = kEmission + 4
};
constexpr const char* kColumnNames[kColumnCount] = {"kind",   "building", "facade",    "floor",     "bay",
                                                    "rho_r",  "rho_g",    "rho_b",     "rho_solar", "emit_r",
                                                    "emit_g", "emit_b",   "emit_solar"};
constexpr bool isOptional(int column)
{
    return column == kRho + 3 || column == kEmission + 3;
}

std::string_view trimmed(std::string_view text)
{
    const size_t begin = std::min(text.find_first_not_of(" \t\""), text.size());
    const size_t end = text.find_last_not_of(" \t\"");
    return end == std::string_view::npos ? std::string_view() : text.substr(begin, end - begin + 1);
}

std::vector<std::string_view> splitFields(std::string_view line)
{
    std::vector<std::string_view> fields;
    for (;;) {
        const size_t comma = line.find(',');
        fields.push_back(trimmed(line.substr(0, comma)));
        if (comma == std::string_view::npos) return fields;
        line.remove_prefix(comma + 1);
    }
}

class TableReader
{
public:
    TableReader(std::string_view text, std::string_view name) : text_(text), name_(name) {}

    Result<std::vector<SurfaceRow>> read()
    {
        if (const Status header = readHeader(); !header) return header.error();
        std::vector<SurfaceRow> rows;
        while (!text_.empty()) {
            const std::string_view line = nextLine();
            if (trimmed(line).empty()) continue;
            Result<SurfaceRow> row = readRow(splitFields(line));
            if (!row) return row.error();
            rows.push_back(std::move(*row));
        }
        return rows;
    }

private:
    Error fail(const std::string& what) const { return Error{concat(name_, ":", line_, ": ", what)}; }
    std::string_view nextLine()
    {
        ++line_;
        return takeLine(text_);
    }

    Status readHeader()
    {
        if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
        const std::vector<std::string_view> names = splitFields(nextLine());
        for (int column = 0; column < kColumnCount; ++column) {
            const auto place = std::find(names.begin(), names.end(), kColumnNames[column]);
            if (place != names.end())
                place_[size_t(column)] = size_t(place - names.begin());
            else if (!isOptional(column))
                return fail(concat("no column \"", kColumnNames[column], "\" in the header"));
        }
        return Nothing{};
    }

    bool has(int column) const { return place_[size_t(column)] != kAbsent; }

    Result<SurfaceRow> readRow(const std::vector<std::string_view>& fields) const
    {
        SurfaceRow row;
        std::array<double, kColumnCount> values{};
        for (int column = 0; column < kColumnCount; ++column) {
            if (!has(column)) continue;
            const size_t place = place_[size_t(column)];
            if (place >= fields.size())
                return fail(
                    concat("only ", fields.size(), " fields, but \"", kColumnNames[column], "\" is field ", place + 1));
            const std::string_view field = fields[place];
            const auto bad = [&](const char* what) {
                return fail(concat(kColumnNames[column], " \"", field, "\" ", what));
            };
            if (column == kKind) {
                row.kind = field;
            } else if (column < kRho) {
                if (!parseInteger(field, row.path[size_t(column - kBuilding)])) return bad("is not a whole number");
                if (column == kBuilding && row.path[0] < -1) return bad("is below -1, the ground");
            } else {
                double& value = values[size_t(column)];
                if (!parseNumber(field, value)) return bad("is not a number");
                if (column < kEmission && (value < 0.0 || value > 1.0)) return bad("is outside 0..1");
                if (value < 0.0) return bad("is negative");
            }
        }
        for (int i = 0; i < 4; ++i) {
            row.rho[i] = values[size_t(kRho + i)];
            row.emission[i] = values[size_t(kEmission + i)];
        }
        if (!has(kRho + 3)) row.rho.a = solarFromRgb(glm::dvec3(row.rho));
        if (!has(kEmission + 3)) row.emission.a = solarFromRgb(glm::dvec3(row.emission));
        return row;
    }

    static constexpr size_t kAbsent = ~size_t(0);
    std::string_view text_, name_;
    u32 line_ = 0;
    std::array<size_t, kColumnCount> place_ = [] {
        std::array<size_t, kColumnCount> absent{};
        absent.fill(kAbsent);
        return absent;
    }();
};

// Grows the tree face by face; groups appear with their first face.
class TreeBuilder
{
public:
    void add(const SurfaceRow& row, Ring3 ring, u32 face)
    {
        const u32 bay = groupOf(row);
        Shape& leaf = addShape(bay, row.kind, ShapeOp::Group, tree_.shapes[bay].building);
        leaf.polygonBegin = u32(tree_.polygons.size());
        leaf.polygonCount = 1;
        leaf.sourceFace = face;
        leaf.surface = surfaceOf(row);
        tree_.polygons.push_back({std::move(ring), {}});
    }
    ShapeTree take() { return std::move(tree_); }

private:
    Shape& addShape(u32 parent, const std::string& name, ShapeOp op, u32 building)
    {
        Shape shape;
        shape.parent = parent;
        const auto [place, isNew] = names_.emplace(name, u32(tree_.names.size()));
        if (isNew) tree_.names.push_back(name);
        shape.name = place->second;
        shape.op = op;
        shape.building = building;
        return tree_.shapes.emplace_back(shape);
    }

    u32 groupOf(const SurfaceRow& row)
    {
        static const std::string kLevels[] = {"Building", "Facade", "Floor", "Bay"};
        std::vector<i64> path;
        u32 group = kNoIndex;
        for (size_t level = 0; level < 4; ++level) {
            path.push_back(row.path[level]);
            const auto [place, isNew] = groups_.emplace(path, u32(tree_.shapes.size()));
            if (isNew) {
                const bool isGround = row.path[0] < 0;
                u32 building = group == kNoIndex ? kNoIndex : tree_.shapes[group].building;
                if (level == 0 && !isGround) {
                    building = u32(tree_.buildingIds.size());
                    tree_.buildingIds.push_back(std::to_string(row.path[0]));
                }
                addShape(group, level == 0 && isGround ? "Ground" : kLevels[level],
                         level == 0 ? ShapeOp::Root : ShapeOp::Group, building);
            }
            group = place->second;
        }
        return group;
    }

    u32 surfaceOf(const SurfaceRow& row)
    {
        std::vector<double> key;
        for (int i = 0; i < 4; ++i) key.insert(key.end(), {row.rho[i], row.emission[i]});
        const auto [place, isNew] = surfaces_.emplace(std::pair(row.kind, key), u32(tree_.surfaces.size()));
        if (isNew) tree_.surfaces.push_back({row.kind, row.rho, row.emission});
        return place->second;
    }

    ShapeTree tree_;
    std::map<std::string, u32> names_;
    std::map<std::vector<i64>, u32> groups_;
    std::map<std::pair<std::string, std::vector<double>>, u32> surfaces_;
};

} // namespace

Result<ShapeTree> readSurfaces(const std::filesystem::path& obj, const std::filesystem::path& csv)
{
    const Result<std::string> objText = readTextFile(obj);
    if (!objText) return objText.error();
    const Result<std::string> csvText = readTextFile(csv);
    if (!csvText) return csvText.error();
    Result<std::vector<ObjFace>> faces = readObjFaces(*objText, obj.string());
    if (!faces) return faces.error();
    const Result<std::vector<SurfaceRow>> rows = TableReader(*csvText, csv.string()).read();
    if (!rows) return rows.error();
    if (faces->size() != rows->size())
        return Error{concat(csv.string(), ": ", rows->size(), " rows for the ", faces->size(), " faces of ",
                            obj.string(), "; face k belongs to row k")};
    if (faces->empty()) return Error{concat(obj.string(), ": no face")};
    TreeBuilder builder;
    for (u32 k = 0; k < rows->size(); ++k) builder.add((*rows)[k], std::move((*faces)[k].ring), k);
    return builder.take();
}

} // namespace helio
