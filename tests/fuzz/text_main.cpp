// SPDX-License-Identifier: Apache-2.0
// Runs a text target on its corpus and then on mutations of it:
//   NAME_fuzz [--count N | --seconds S] [--seed K] [--limit S] [--keep FOLDER] FILE_OR_FOLDER...
// --count (default 20000): so many mutations, the same ones every time; 0: the corpus alone. --seconds: for so long.
// --limit (default 10): CPU seconds for one input, then it counts as a hang. The input at work lies in
// FOLDER/NAME.input (default: the current folder) and stays there after a crash or a hang.
// With -fsanitize-coverage=trace-pc inputs that reach new places join the corpus.
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "city/base/file.h"
#include "tests/fuzz/text_mutator.h"
#include "tests/fuzz/text_target.h"

namespace {

constexpr size_t kPlaces = 1 << 18;
unsigned char placesSeen[kPlaces];
size_t newPlaces = 0;

} // namespace

// Called at every branch of code that was compiled with -fsanitize-coverage=trace-pc.
extern "C" __attribute__((no_sanitize_coverage)) void __sanitizer_cov_trace_pc()
{
    const auto place = reinterpret_cast<std::uintptr_t>(__builtin_return_address(0)) -
                       reinterpret_cast<std::uintptr_t>(&__sanitizer_cov_trace_pc);
    unsigned char& seen = placesSeen[(place * 0x9E3779B97F4A7C15ull) >> 46];
    newPlaces += seen == 0;
    seen = 1;
}

namespace helio::fuzz {
namespace {

constexpr size_t kLargestText = 200000;      // bytes of a mutation
constexpr size_t kLargestKept = 60000;       // bytes of an input that joins the corpus
constexpr long kLargestMemory = 4096 * 1024; // KiB

struct Options
{
    u64 count = 20000, seed = 1;
    double seconds = 0.0;
    int limit = 10;
    std::filesystem::path keep = ".";
    std::vector<std::filesystem::path> corpus;
};

[[noreturn]] void stop(const std::string& why)
{
    std::fprintf(stderr, "%s_fuzz: %s\n", std::string(textTarget.name).c_str(), why.c_str());
    std::_Exit(1);
}

void onTimeLimit(int)
{
    constexpr char kText[] = "fuzz: the input takes longer than the limit\n";
    (void)!write(2, kText, sizeof kText - 1);
    std::abort();
}

// Writes the input down, then runs the target on it: whatever ends the process leaves the input behind.
class Runner
{
public:
    explicit Runner(const Options& options)
        : limit_(options.limit), path_((options.keep / (std::string(textTarget.name) + ".input")).string()),
          file_(open(path_.c_str(), O_CREAT | O_TRUNC | O_RDWR, 0644))
    {
        if (file_ < 0) stop(path_ + " cannot be written");
        signal(SIGPROF, onTimeLimit);
    }
    void run(const std::string& text)
    {
        if (pwrite(file_, text.data(), text.size(), 0) != ssize_t(text.size()) ||
            ftruncate(file_, off_t(text.size())) != 0)
            stop(path_ + " cannot be written");
        setTimer(limit_);
        // A block of exactly the size, so that a sanitizer sees one byte too far.
        const std::vector<std::uint8_t> bytes(text.begin(), text.end());
        LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
        setTimer(0);
        rusage usage{};
        getrusage(RUSAGE_SELF, &usage);
        if (usage.ru_maxrss > kLargestMemory) stop(path_ + ": the input fills the memory");
    }
    void finish()
    {
        close(file_);
        std::filesystem::remove(path_);
    }

private:
    static void setTimer(int seconds)
    {
        const itimerval timer{{0, 0}, {seconds, 0}};
        setitimer(ITIMER_PROF, &timer, nullptr);
    }

    int limit_;
    std::string path_;
    int file_;
};

Options optionsOf(int argc, char** argv)
{
    Options options;
    for (int i = 1; i < argc; ++i) {
        const std::string_view word = argv[i];
        if (!word.starts_with("--")) {
            options.corpus.emplace_back(word);
            continue;
        }
        if (i + 1 >= argc) stop(std::string(word) + " needs a value");
        const char* value = argv[++i];
        if (word == "--count")
            options.count = std::strtoull(value, nullptr, 10);
        else if (word == "--seconds")
            options.seconds = std::strtod(value, nullptr);
        else if (word == "--seed")
            options.seed = std::strtoull(value, nullptr, 10);
        else if (word == "--limit")
            options.limit = std::atoi(value);
        else if (word == "--keep")
            options.keep = value;
        else
            stop("unknown option " + std::string(word));
    }
    return options;
}

std::vector<std::string> readCorpus(const std::vector<std::filesystem::path>& places)
{
    std::vector<std::filesystem::path> files;
    for (const std::filesystem::path& place : places) {
        if (!std::filesystem::is_directory(place)) {
            files.push_back(place);
            continue;
        }
        for (const auto& entry : std::filesystem::recursive_directory_iterator(place))
            if (entry.is_regular_file()) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    std::vector<std::string> corpus;
    for (const std::filesystem::path& file : files) {
        Result<std::string> text = readTextFile(file);
        if (!text) stop(text.error().message);
        corpus.push_back(std::move(*text));
    }
    if (corpus.empty()) stop("no corpus; name files or folders");
    return corpus;
}

int run(const Options& options)
{
    std::vector<std::string> corpus = readCorpus(options.corpus);
    Runner runner(options);
    for (const std::string& text : corpus) runner.run(text);
    const u64 accepted = acceptedTexts;
    const size_t files = corpus.size();
    const auto start = std::chrono::steady_clock::now();
    const auto seconds = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    u64 runs = 0;
    while (options.seconds > 0.0 ? seconds() < options.seconds : runs < options.count) {
        Random random(mixSeed(options.seed, runs++));
        const std::string& text = corpus[size_t(random.next() % corpus.size())];
        const std::string& other = corpus[size_t(random.next() % corpus.size())];
        const std::string changed = mutateText(text, other, textTarget.words, kLargestText, random);
        newPlaces = 0;
        runner.run(changed);
        if (newPlaces > 0 && changed.size() <= kLargestKept) corpus.push_back(changed);
    }
    runner.finish();
    std::printf(
        "%zu files, %llu of them accepted; %llu mutations, %llu accepted, %llu refused; %zu joined the corpus\n", files,
        static_cast<unsigned long long>(accepted), static_cast<unsigned long long>(runs),
        static_cast<unsigned long long>(acceptedTexts - accepted), static_cast<unsigned long long>(refusedTexts),
        corpus.size() - files);
    if (runs == 0) return 0;
    return acceptedTexts > accepted && refusedTexts > 0 ? 0 : 1;
}

} // namespace
} // namespace helio::fuzz

int main(int argc, char** argv)
{
    return helio::fuzz::run(helio::fuzz::optionsOf(argc, argv));
}
