// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "city/base/file.h"
#include "city/base/hash.h"
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

// First values of SplitMix64 seeded with 0, as published with the generator (prng.di.unimi.it/splitmix64.c run by hand).
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
    size_t entries = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) entries += entry.exists() ? 1 : 0;
    EXPECT_EQ(entries, 1u);
    std::filesystem::remove_all(folder);
}
