// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <stdexcept>
#include <sys/resource.h>
#include <vector>

#include "city/base/file.h"
#include "city/base/hash.h"
#include "city/base/json_depth.h"
#include "city/base/parallel.h"

using namespace helio;

TEST(ParallelFor, VisitsEveryItemOnceForAnyNumberOfThreads)
{
    for (const u32 jobs : {1u, 2u, 7u}) {
        for (const u32 count : {0u, 1u, 63u, 64u, 65u, 1000u}) {
            std::vector<int> visits(count, 0);
            parallelFor(count, 64, jobs, [&](u32 begin, u32 end) {
                for (u32 i = begin; i < end; ++i) ++visits[i];
            });
            EXPECT_EQ(visits, std::vector<int>(count, 1)) << jobs << " jobs, " << count << " items";
        }
    }
}

TEST(ParallelFor, ChunksDoNotDependOnTheNumberOfThreads)
{
    const auto chunkOf = [](u32 jobs) {
        std::vector<u32> begins(100, 0);
        parallelFor(100, 7, jobs, [&](u32 begin, u32 end) {
            for (u32 i = begin; i < end; ++i) begins[i] = begin;
        });
        return begins;
    };
    EXPECT_EQ(chunkOf(1), chunkOf(3));
}

TEST(ParallelFor, CountsNearTheTopOfTheRangeDoNotWrap)
{
    std::vector<u32> ends;
    parallelFor(0xFFFFFFFFu, 0x80000000u, 1, [&](u32, u32 end) { ends.push_back(end); });
    EXPECT_EQ(ends, (std::vector<u32>{0x80000000u, 0xFFFFFFFFu}));
}

TEST(ParallelFor, AnExceptionOfTheBodyComesOutAtTheCaller)
{
    for (const u32 jobs : {1u, 4u}) {
        std::atomic<u32> chunks{0};
        const auto body = [&](u32 begin, u32) {
            ++chunks;
            if (begin >= 10) throw std::runtime_error("no memory");
        };
        EXPECT_THROW(parallelFor(100000, 1, jobs, body), std::runtime_error);
        EXPECT_GE(chunks, 11u);
        EXPECT_LT(chunks, 100000u) << "the work goes on after it failed";
    }
}

TEST(ParallelFor, WorksWithTheThreadsThatTheSystemGives)
{
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the sanitizer itself needs the address space";
#endif
    // No room for the stacks of so many threads.
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
    if (before.rlim_cur != RLIM_INFINITY) GTEST_SKIP() << "the address space is limited already";
    rlimit small = before;
    small.rlim_cur = rlim_t(1) << 30;
    if (setrlimit(RLIMIT_AS, &small) != 0) GTEST_SKIP() << "the address space cannot be limited";
    std::vector<int> visits(20000, 0);
    parallelFor(u32(visits.size()), 1, 20000, [&](u32 begin, u32) { ++visits[begin]; });
    setrlimit(RLIMIT_AS, &before);
    EXPECT_EQ(visits, std::vector<int>(20000, 1));
}

TEST(JsonDepth, FindsTheBracketThatIsOneTooMuch)
{
    EXPECT_FALSE(findDeepJson("", 0));
    EXPECT_FALSE(findDeepJson("[{}]", 2));
    EXPECT_EQ(findDeepJson("[{}]", 1), 1u);
    EXPECT_EQ(findDeepJson("[[],[],[[]]]", 2), 8u) << "closed brackets do not count";
    EXPECT_FALSE(findDeepJson(R"(["[[[[", "\"[[[["])", 1)) << "brackets in texts do not count";
    EXPECT_EQ(findDeepJson(R"(["\\",[]])", 1), 6u) << "an escaped backslash does not hide the quote behind it";
    EXPECT_FALSE(findDeepJson("]]]][", 1));
}

// First values of SplitMix64 seeded with 0, as published with the generator (prng.di.unimi.it/splitmix64.c run by
// hand).
TEST(Random, IsSplitMix64)
{
    Random random(0);
    EXPECT_EQ(random.next(), 0xE220A8397B1DCDAFull);
    EXPECT_EQ(random.next(), 0x6E789E6AA1B965F4ull);
}

TEST(Hash, OrderOfMixingMatters)
{
    EXPECT_NE(mixSeed(1, 2), mixSeed(2, 1));
    EXPECT_NE(hashText("a"), hashText("b"));
}

TEST(File, MissingFileNamesItselfAndTheReason)
{
    const auto text = readTextFile("no/such/file.txt");
    ASSERT_FALSE(text.ok());
    EXPECT_NE(text.error().message.find("no/such/file.txt"), std::string::npos);
    EXPECT_NE(text.error().message.find("No such file"), std::string::npos);
}

TEST(File, WritesWholeFilesOrNothing)
{
    const auto folder = std::filesystem::temp_directory_path() / "heliopolis_file_test";
    std::filesystem::create_directories(folder);
    ASSERT_TRUE(writeTextAtomically(folder / "a.txt", "light").ok());
    EXPECT_EQ(readTextFile(folder / "a.txt").value(), "light");
    EXPECT_FALSE(writeTextAtomically(folder / "missing" / "b.txt", "light").ok());
    EXPECT_TRUE(checkFileTarget(folder / "b.txt").ok());
    EXPECT_TRUE(checkFileTarget("b.txt").ok());
    EXPECT_FALSE(checkFileTarget(folder / "missing" / "b.txt").ok());
    EXPECT_FALSE(checkFileTarget(folder / "a.txt" / "b.txt").ok());
    EXPECT_FALSE(checkFileTarget(folder).ok());
    size_t entries = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) entries += entry.exists() ? 1 : 0;
    EXPECT_EQ(entries, 1u);
    std::filesystem::remove_all(folder);
}
