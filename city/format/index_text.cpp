// SPDX-License-Identifier: Apache-2.0
#include "city/format/index_text.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "city/base/hash.h"
#include "city/base/json_depth.h"

namespace helio {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kLastWord = "xxh3 ";
constexpr size_t kLastLineBytes = kLastWord.size() + 16 + 1;
constexpr const char* kRemedy = "; bake the pack again";

std::string hex(u64 value)
{
    std::string text(16, '0');
    for (size_t i = 0; i < 16; ++i) text[i] = "0123456789abcdef"[(value >> (60 - 4 * i)) & 15];
    return text;
}

std::optional<u64> fromHex(std::string_view text)
{
    u64 value = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
    if (text.size() != 16 || failure != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

/// Takes members out of the JSON object; the first one that is missing or of another type is remembered.
class MemberReader
{
public:
    explicit MemberReader(const Json& object) : object_(object) {}

    const Json* find(const char* key, bool (*accept)(const Json&))
    {
        const auto member = object_.find(key);
        const bool good = object_.is_object() && member != object_.end() && accept(*member);
        if (!good && wrong_.empty()) wrong_ = key;
        return good ? &*member : nullptr;
    }
    void read(const char* key, std::string& to)
    {
        if (const Json* value = find(key, [](const Json& j) { return j.is_string(); })) to = value->get<std::string>();
    }
    void read(const char* key, double& to)
    {
        if (const Json* value = find(key, isFinite)) to = value->get<double>();
    }
    void read(const char* key, u32& to)
    {
        const auto fits = [](const Json& j) {
            return j.is_number_unsigned() && j.get<u64>() <= std::numeric_limits<u32>::max();
        };
        if (const Json* value = find(key, fits)) to = value->get<u32>();
    }
    void read(const char* key, u64& to)
    {
        if (const Json* value = find(key, [](const Json& j) { return j.is_number_unsigned(); })) to = value->get<u64>();
    }
    void readHex(const char* key, u64& to)
    {
        const auto accept = [](const Json& j) {
            return j.is_string() && fromHex(j.get_ref<const std::string&>()).has_value();
        };
        if (const Json* value = find(key, accept)) to = *fromHex(value->get_ref<const std::string&>());
    }
    template <class Vec> void readVector(const char* key, Vec& to)
    {
        const auto accept = [](const Json& j) {
            return j.is_array() && j.size() == 3 && isFinite(j[0]) && isFinite(j[1]) && isFinite(j[2]);
        };
        const Json* value = find(key, accept);
        for (int i = 0; value != nullptr && i < 3; ++i) to[i] = (*value)[size_t(i)].get<typename Vec::value_type>();
    }
    const std::string& wrongKey() const { return wrong_; }
    void blame(const char* key)
    {
        if (wrong_.empty()) wrong_ = key;
    }

private:
    static bool isFinite(const Json& j) { return j.is_number() && std::isfinite(j.get<double>()); }
    const Json& object_;
    std::string wrong_;
};

template <class Vec> Json vectorJson(const Vec& v)
{
    return Json::array({v.x, v.y, v.z});
}

} // namespace

std::string encodeIndex(const PackIndex& index, const TileEntry& tile)
{
    Json json;
    json["version"] = index.version;
    json["crs"] = index.crs;
    json["origin"] = vectorJson(index.origin);
    json["latitude_deg"] = index.latitudeDeg;
    json["longitude_deg"] = index.longitudeDeg;
    json["north_deg"] = index.northDeg;
    json["source"] = index.source;
    json["rules"] = index.rules;
    json["method"] = index.method;
    json["input_hash"] = hex(index.inputHash);
    json["rules_hash"] = hex(index.rulesHash);
    json["seed"] = index.seed;
    json["options"] = index.options.empty() ? Json::object() : Json::parse(index.options, nullptr, false);
    HELIO_CHECK(json["options"].is_object(), index.options);
    json["source_faces"] = index.sourceFaceCount;
    json["bounds_min"] = vectorJson(index.boundsMin);
    json["bounds_max"] = vectorJson(index.boundsMax);
    json["tiles"] =
        Json::array({{{"file", kTileFile}, {"bytes", tile.bytes}, {"table_checksum", hex(tile.tableChecksum)}}});

    // Text from outside (names) may not be UTF-8; the replacement keeps the index readable.
    std::string text =
        concat(kIndexMagic, index.version, '\n', json.dump(2, ' ', false, Json::error_handler_t::replace), '\n');
    return text + concat(kLastWord, hex(hashText(text)), '\n');
}

Result<IndexText> decodeIndex(std::string_view text, const std::string& name)
{
    const auto fail = [&](size_t offset, const auto&... parts) {
        return Error{concat(name, ": byte ", offset, ": ", parts..., kRemedy)};
    };
    if (text.substr(0, kIndexMagic.size()) != kIndexMagic)
        return Error{concat(name, ": byte 0: this is not the index of a pack")};
    u32 version = 0;
    const char* const digits = text.data() + kIndexMagic.size();
    const auto [digitsEnd, failure] = std::from_chars(digits, text.data() + text.size(), version);
    const size_t lineEnd = size_t(digitsEnd - text.data());
    if (failure != std::errc{} || lineEnd >= text.size() || text[lineEnd] != '\n')
        return fail(kIndexMagic.size(), "the first line has no version number");
    if (version != kPackVersion)
        return fail(kIndexMagic.size(), "version ", version, " of the format, this program reads version ",
                    kPackVersion);

    const std::string_view last = text.size() >= kLastLineBytes ? text.substr(text.size() - kLastLineBytes) : "";
    const std::optional<u64> checksum = last.substr(0, kLastWord.size()) == kLastWord && last.back() == '\n'
                                            ? fromHex(last.substr(kLastWord.size(), 16))
                                            : std::nullopt;
    if (!checksum) return fail(text.size(), "the file does not end with its checksum line");
    const std::string_view body = text.substr(0, text.size() - kLastLineBytes);
    if (hashText(body) != *checksum) return fail(body.size(), "the checksum of the index does not match");

    const std::string_view document = body.substr(lineEnd);
    if (const std::optional<size_t> deep = findDeepJson(document))
        return fail(lineEnd + *deep, "this nests deeper than ", kMaxJsonDepth, " levels");
    Json json;
    try {
        json = Json::parse(document);
    } catch (const Json::parse_error& error) {
        return fail(lineEnd + error.byte, "this is not JSON");
    } catch (const Json::exception&) { // A number that no double can hold, for one.
        return fail(lineEnd, "this JSON holds a value that cannot be read");
    }
    IndexText out;
    PackIndex& index = out.index;
    MemberReader members(json);
    members.read("version", index.version);
    members.read("crs", index.crs);
    members.readVector("origin", index.origin);
    members.read("latitude_deg", index.latitudeDeg);
    members.read("longitude_deg", index.longitudeDeg);
    members.read("north_deg", index.northDeg);
    members.read("source", index.source);
    members.read("rules", index.rules);
    members.read("method", index.method);
    members.readHex("input_hash", index.inputHash);
    members.readHex("rules_hash", index.rulesHash);
    members.read("seed", index.seed);
    if (const Json* options = members.find("options", [](const Json& j) { return j.is_object(); }))
        index.options = options->dump();
    members.read("source_faces", index.sourceFaceCount);
    members.readVector("bounds_min", index.boundsMin);
    members.readVector("bounds_max", index.boundsMax);
    if (const Json* tiles = members.find("tiles", [](const Json& j) { return j.is_array() && j.size() == 1; })) {
        MemberReader tile(tiles->front());
        std::string file;
        tile.read("file", file);
        tile.read("bytes", out.tile.bytes);
        tile.readHex("table_checksum", out.tile.tableChecksum);
        if (!tile.wrongKey().empty() || file != kTileFile) members.blame("tiles");
    }
    for (int i = 0; i < 3; ++i)
        if (!(index.boundsMin[i] <= index.boundsMax[i]) || !std::isfinite(index.boundsMin[i]) ||
            !std::isfinite(index.boundsMax[i]))
            members.blame("bounds_min");
    if (std::abs(index.latitudeDeg) > 90.0) members.blame("latitude_deg");
    if (std::abs(index.longitudeDeg) > 180.0) members.blame("longitude_deg");
    if (std::abs(index.northDeg) > 360.0) members.blame("north_deg");
    if (index.version != version) members.blame("version");
    if (!members.wrongKey().empty())
        return fail(lineEnd + 1, "member \"", members.wrongKey(), "\" is missing or not valid");
    return out;
}

} // namespace helio
