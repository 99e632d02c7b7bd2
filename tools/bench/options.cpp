// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/options.h"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "tools/support/number_in.h"

namespace helio {

Result<BenchOptions> parseCommandLine(int argc, char** argv, bool& done)
{
    BenchOptions o;
    CLI::App app{
        "Times the kernels on made-up data and, with a pack, the stages on it: median, minimum and spread over\n"
        "the repetitions, in milliseconds, and ratios to naive variants, to the host and to rooflines.\n"
        "Compare figures of one run only. Exit codes: 0 = ok, 1 = bad input or usage, 2 = device or internal.",
        "heliopolis-bench"};
    app.add_option("PACK", o.pack, "pack folder, from heliopolis-bake; none = the kernels alone");
    app.add_option("--only", o.only, "run the cases whose names hold this text");
    app.add_option("--compare", o.compare, "compare the medians of two files of --json; runs nothing")
        ->expected(2)
        ->type_name("A.json B.json");
    app.add_option("--json", o.json, "every repetition, as Google Benchmark's JSON");
    app.add_option("--repeats", o.repeats, "repetitions of each case")
        ->check(CLI::Range(1u, 1000u))
        ->capture_default_str();
    app.add_option("--residual", o.residual, "where the sweeps stop")
        ->check(numberIn(1e-7, 1.0))
        ->capture_default_str();
    app.add_option("--camera", o.camera, "as of heliopolis-render")->capture_default_str();
    app.add_option("--size", o.size, "WIDTHxHEIGHT of the frame, pixels")->capture_default_str();
    app.add_option("--sun-texel", o.sunTexel, "size of a texel of the sun raster, m; 0 = the default")
        ->check(numberIn(0.0, 100.0))
        ->capture_default_str();
    app.add_option("--copy", o.copyMiB, "size of the stream copy, MiB")
        ->check(CLI::Range(1u, 1024u))
        ->capture_default_str();
    app.add_option("--device", o.device, "part of the Vulkan device's name (default: HELIO_DEVICE, else the fastest)");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() != 0) return Error{concat(error.what(), "; see --help")};
        done = true;
        app.exit(error);
        return o;
    }
    int used = 0;
    if (std::sscanf(o.size.c_str(), "%ux%u%n", &o.width, &o.height, &used) != 2 || size_t(used) != o.size.size() ||
        o.width < 1 || o.height < 1 || o.width > 4096 || o.height > 4096)
        return Error{concat("--size ", o.size, ": expected WIDTHxHEIGHT in pixels, 1 to 4096 each")};
    return o;
}

} // namespace helio
