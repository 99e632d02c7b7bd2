// SPDX-License-Identifier: Apache-2.0
// The folder on disk: complete or not there, replaced only if it is a pack, the same bytes every time.
#include <gtest/gtest.h>

#include "city/base/file.h"
#include "city/pack/writer.h"
#include "tests/unit/pack_sample.h"
#include "tests/unit/pack_temp_folder.h"

namespace helio {
namespace {

using test::samplePack;
using test::TempFolder;

std::string textOf(const std::filesystem::path& path)
{
    Result<std::string> text = readTextFile(path);
    EXPECT_TRUE(text.ok());
    return text ? *text : "";
}

TEST(PackWriter, WrittenPackOpens)
{
    const TempFolder temp;
    for (const bool zstd : {false, true}) {
        const std::filesystem::path folder = temp / (zstd ? "packed" : "plain");
        const Result<LinkBytes> written = writePack(samplePack(), folder, {.zstd = zstd});
        ASSERT_TRUE(written.ok()) << written.error().message;
        const Result<Pack> pack = Pack::open(folder);
        ASSERT_TRUE(pack.ok()) << pack.error().message;
        EXPECT_EQ(pack->patchCount(), 3u);
        EXPECT_EQ(pack->nodeCount(), 5u);
        EXPECT_EQ(pack->tile().linkFactors[3], 0.25f);
        EXPECT_EQ(pack->tile().draws[1].vertexOffset, 6u);
        EXPECT_EQ(pack->index().seed, 0xFFFFFFFFFFFFFFFFull);
        EXPECT_EQ(splitNames(pack->tile().nodeNames), (std::vector<std::string>{"Facade", "Wall", "Ground"}));
        for (const gpu::PatchRecord& patch : pack->tile().patches)
            EXPECT_EQ(reinterpret_cast<std::uintptr_t>(&patch) % 4, 0u);
    }
    EXPECT_EQ(temp.entryCount(), 2u) << "no temporary folder may stay";
}

TEST(PackWriter, TheSpansOutliveThePackTheyWereCopiedFrom)
{
    const TempFolder temp;
    ASSERT_TRUE(writePack(samplePack(), temp / "p").ok());
    std::optional<Pack> kept;
    {
        Result<Pack> pack = Pack::open(temp / "p");
        ASSERT_TRUE(pack.ok());
        kept = *pack;
    }
    EXPECT_EQ(kept->tile().linkColumns[3], 1u);
}

TEST(PackWriter, SameContentSameBytes)
{
    const TempFolder temp;
    ASSERT_TRUE(writePack(samplePack(), temp / "a").ok());
    ASSERT_TRUE(writePack(samplePack(), temp / "b").ok());
    EXPECT_EQ(textOf(temp / "a/index"), textOf(temp / "b/index"));
    EXPECT_EQ(textOf(temp / "a/tile-0000"), textOf(temp / "b/tile-0000"));
}

TEST(PackWriter, ReplacesAPackAndNothingElse)
{
    const TempFolder temp;
    ASSERT_TRUE(writePack(samplePack(), temp / "p").ok());
    PackContent changed = samplePack();
    changed.index.seed = 4;
    ASSERT_TRUE(writePack(changed, temp / "p/").ok()) << "a trailing slash is harmless";
    EXPECT_EQ(Pack::open(temp / "p")->index().seed, 4u);
    EXPECT_EQ(temp.entryCount(), 1u);

    std::filesystem::create_directory(temp / "empty");
    EXPECT_FALSE(writePack(changed, temp / "empty").ok());
    ASSERT_TRUE(writeTextAtomically(temp / "file", "precious").ok());
    EXPECT_FALSE(writePack(changed, temp / "file").ok());
    EXPECT_EQ(textOf(temp / "file"), "precious");
    ASSERT_TRUE(writeTextAtomically(temp / "p/notes.txt", "precious").ok());
    EXPECT_FALSE(writePack(changed, temp / "p").ok());
    EXPECT_EQ(textOf(temp / "p/notes.txt"), "precious");
    EXPECT_FALSE(writePack(changed, temp / "missing/p").ok());
    EXPECT_FALSE(writePack(changed, temp / "..").ok());
    EXPECT_EQ(temp.entryCount(), 3u);
}

TEST(PackWriter, AnInterruptedWriteLeavesNothing)
{
    PackContent content = samplePack(); // A name of 20 MiB: its section is written in several chunks.
    content.surfaceNames = std::string(size_t(20) << 20, 'x') + "\nstreet\n";
    int needed = 0;
    {
        const TempFolder temp;
        ASSERT_TRUE(writePack(content, temp / "p", {.cancelled = [&] { return ++needed, false; }}).ok());
    }
    EXPECT_GT(needed, 20) << "table, index, most of the sections and the chunks of one of them";
    for (const bool replacing : {false, true}) {
        for (int last = 0; last < needed; ++last) {
            const TempFolder temp;
            if (replacing) {
                ASSERT_TRUE(writePack(samplePack(), temp / "p").ok());
            }
            const std::string before = replacing ? textOf(temp / "p/tile-0000") : "";
            int calls = 0;
            const Result<LinkBytes> written =
                writePack(content, temp / "p", {.cancelled = [&] { return ++calls > last; }});
            ASSERT_FALSE(written.ok());
            EXPECT_NE(written.error().message.find("interrupted"), std::string::npos);
            ASSERT_EQ(temp.entryCount(), replacing ? 1u : 0u) << "interrupted at " << last;
            EXPECT_EQ(replacing ? textOf(temp / "p/tile-0000") : "", before);
        }
    }
}

TEST(PackWriter, RefusesWhatAReaderWouldRefuse)
{
    const TempFolder temp;
    PackContent content = samplePack();
    content.linkColumns[0] = 77;
    EXPECT_FALSE(writePack(content, temp / "p").ok());
    EXPECT_EQ(temp.entryCount(), 0u);
    const Status good = checkContent(content, "p");
    ASSERT_FALSE(good.ok());
    EXPECT_NE(good.error().message.find("p: not written, the bake is faulty"), std::string::npos);
    EXPECT_TRUE(checkContent(samplePack(), "p").ok());
}

TEST(PackOpen, SaysWhatIsWrongWithAFolder)
{
    const TempFolder temp;
    EXPECT_NE(Pack::open(temp / "none").error().message.find("there is no such pack"), std::string::npos);
    EXPECT_NE(Pack::open(temp.path()).error().message.find("has no file 'index'"), std::string::npos);
    ASSERT_TRUE(writeTextAtomically(temp / "file", "x").ok());
    EXPECT_NE(Pack::open(temp / "file").error().message.find("a pack is a folder"), std::string::npos);
    ASSERT_TRUE(writePack(samplePack(), temp / "p").ok());
    std::filesystem::remove(temp / "p/tile-0000");
    EXPECT_NE(Pack::open(temp / "p").error().message.find("tile-0000: cannot be opened"), std::string::npos);
    ASSERT_TRUE(writeTextAtomically(temp / "p/tile-0000", "").ok());
    EXPECT_NE(Pack::open(temp / "p").error().message.find("ends inside the header"), std::string::npos);
}

TEST(PackOpen, RefusesATileOfAnotherBake)
{
    const TempFolder temp;
    ASSERT_TRUE(writePack(samplePack(), temp / "a").ok());
    PackContent other = samplePack();
    other.skyFactors[0] = 0.25f;
    ASSERT_TRUE(writePack(other, temp / "b").ok());
    std::filesystem::copy_file(temp / "b/tile-0000", temp / "a/tile-0000",
                               std::filesystem::copy_options::overwrite_existing);
    EXPECT_NE(Pack::open(temp / "a").error().message.find("another bake"), std::string::npos);
}

} // namespace
} // namespace helio
