// SPDX-License-Identifier: Apache-2.0
#include "engine/view/camera_path.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace helio {

namespace {

/// What is interpolated of a camera.
struct State
{
    glm::dvec3 eye, target;
    double fov;
};

State operator+(const State& a, const State& b)
{
    return {a.eye + b.eye, a.target + b.target, a.fov + b.fov};
}
State operator*(double s, const State& a)
{
    return {s * a.eye, s * a.target, s * a.fov};
}

State stateOf(const PathKey& key)
{
    return {key.camera.eye, key.camera.target, key.camera.fovDegrees};
}

/// Per second, at key k.
State speedAt(const std::vector<PathKey>& path, size_t k)
{
    const size_t before = k > 0 ? k - 1 : k, after = std::min(k + 1, path.size() - 1);
    return 1.0 / (path[after].seconds - path[before].seconds) * (stateOf(path[after]) + -1.0 * stateOf(path[before]));
}

Result<PathKey> parseKey(const std::string& line)
{
    PathKey key;
    Camera& c = key.camera;
    int used = 0;
    const int count = std::sscanf(line.c_str(), "%lf %lf,%lf,%lf,%lf,%lf,%lf%n", &key.seconds, &c.eye.x, &c.eye.y,
                                  &c.eye.z, &c.target.x, &c.target.y, &c.target.z, &used);
    std::string rest = count == 7 ? line.substr(size_t(used)) : "";
    rest.erase(rest.find_last_not_of(" \t\r") + 1);
    if (count == 7 && !rest.empty()) {
        int more = 0;
        if (std::sscanf(rest.c_str(), ",%lf%n", &c.fovDegrees, &more) != 1 || size_t(more) != rest.size())
            return Error{concat("'", rest, "' after the target; expected nothing or ,FOV")};
    }
    if (count != 7) return Error{"expected: seconds x,y,z,tx,ty,tz[,fov]"};
    for (const double value : {key.seconds, c.eye.x, c.eye.y, c.eye.z, c.target.x, c.target.y, c.target.z})
        if (!std::isfinite(value)) return Error{"a number that is not finite"};
    if (c.eye == c.target) return Error{"the eye is where the target is"};
    if (!(c.fovDegrees >= 1.0 && c.fovDegrees <= 170.0))
        return Error{concat("field of view ", c.fovDegrees, " is not within 1 to 170 degrees")};
    return key;
}

} // namespace

Result<std::vector<PathKey>> parseCameraPath(std::string_view text)
{
    std::vector<PathKey> path;
    u32 number = 0;
    while (!text.empty()) {
        const size_t end = std::min(text.find('\n'), text.size());
        std::string line(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        ++number;
        line.resize(std::min(line.find('#'), line.size()));
        if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
        const Result<PathKey> key = parseKey(line);
        if (!key) return Error{concat("line ", number, ": ", key.error().message)};
        if (path.empty() ? key->seconds < 0.0 : key->seconds <= path.back().seconds)
            return Error{concat("line ", number, ": time ", key->seconds, " s; times start at 0 or later and ascend")};
        path.push_back(*key);
    }
    if (path.size() < 2) return Error{concat(path.size(), " keys; a path needs two at least")};
    return path;
}

Camera cameraAt(const std::vector<PathKey>& path, double seconds)
{
    HELIO_CHECK(path.size() >= 2, path.size(), " keys");
    if (seconds <= path.front().seconds) return path.front().camera;
    if (seconds >= path.back().seconds) return path.back().camera;
    const size_t next = size_t(std::upper_bound(path.begin(), path.end(), seconds,
                                                [](double t, const PathKey& key) { return t < key.seconds; }) -
                               path.begin());
    const PathKey &a = path[next - 1], &b = path[next];
    const double length = b.seconds - a.seconds, t = (seconds - a.seconds) / length, u = 1.0 - t;
    // Hermite's cubic between the keys.
    const State state = u * u * (1.0 + 2.0 * t) * stateOf(a) + t * t * (3.0 - 2.0 * t) * stateOf(b) +
                        length * t * u * u * speedAt(path, next - 1) + -length * t * t * u * speedAt(path, next);
    Camera camera = a.camera;
    camera.eye = state.eye;
    camera.target = state.target;
    camera.fovDegrees = std::clamp(state.fov, 1.0, 170.0);
    return camera;
}

} // namespace helio
