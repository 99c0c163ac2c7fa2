// Heads of files, kept as they were baked.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include "fsm/asset/asset_writer.h"
#include "fsm/faces/head_cache.h"
#include "fsm/faces/head_of_file.h"
#include "fsm/head/make_head.h"
#include "tests/fsm/render_support.h"

namespace fsm {
namespace {

class HeadCacheTest : public testing::Test {
 protected:
  HeadCacheTest() {
    std::filesystem::create_directory(folder_ / "heads");
    WriteHead("a.obj", 1);
  }

  /// A pyramid of this height.
  void WriteHead(const std::string& name, int height) {
    std::ofstream(folder_ / ("heads/" + name)) << "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 " << height
                                               << "\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
  }

  struct Made {
    std::size_t vertices;
    std::string said;
  };
  Made Make(const std::string& name = "a.obj") {
    std::string said;
    const HeadCache cache(cache_, [&said](const std::string& line) { said += line; });
    const auto head = cache.HeadOfFile(folder_ / ("heads/" + name), {});
    return {head->rig().data().rest.size(), said};
  }

  std::size_t Kept(const std::string& extension) const {
    return static_cast<std::size_t>(std::ranges::count_if(
        std::filesystem::directory_iterator(cache_),
        [&](const auto& file) { return file.path().extension() == extension; }));
  }
  std::string OnlyKept() const {
    for (const auto& file : std::filesystem::directory_iterator(cache_)) {
      if (file.path().extension() == ".glb") return file.path().string();
    }
    return "";
  }

  TemporaryFolder folder_;
  std::string cache_ = folder_ / "cache/of/heads";
};

TEST_F(HeadCacheTest, AHeadIsBakedOnceAndItsNoticeToldEachTime) {
  const Made baked = Make();
  EXPECT_NE(baked.said.find("has no shapes"), std::string::npos) << baked.said;
  EXPECT_EQ(Kept(".glb"), 1U);
  // What is found is what is kept: here another head, put in its place.
  const auto other = MakeHead("pygmalion");
  std::ofstream(OnlyKept(), std::ios::binary) << WriteAsset(*other, {});
  const Made found = Make();
  EXPECT_EQ(found.vertices, other->rig().data().rest.size());
  EXPECT_EQ(found.said, baked.said);
}

TEST_F(HeadCacheTest, AKeptHeadIsTheBakedOne) {
  Make();
  const auto baked = MakeHeadOfFile(folder_ / "heads/a.obj", {}).head;
  const auto kept =
      HeadCache(cache_, [](const std::string&) {}).HeadOfFile(folder_ / "heads/a.obj", {});
  FaceState state;
  state.au.left[26] = state.au.right[26] = 1;
  state.head_rotation = {5, 10, 0};
  HeadVertices a, b;
  baked->Evaluate(state, a);
  kept->Evaluate(state, b);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.normal, b.normal);
}

TEST_F(HeadCacheTest, WhatHasChangedIsBakedAnew) {
  const std::size_t vertices = Make().vertices;
  const auto spoil = [this] {
    for (const auto& file : std::filesystem::directory_iterator(cache_)) {
      if (file.path().extension() == ".glb") std::ofstream(file.path()) << "nothing";
    }
  };
  WriteHead("a.obj", 12345);
  spoil();
  EXPECT_EQ(Make().vertices, vertices);
  EXPECT_EQ(Kept(".glb"), 2U);
  std::ofstream(folder_ / "heads/happy.png") << "a picture beside it, which it does not name";
  EXPECT_EQ(Make().vertices, vertices);
  EXPECT_EQ(Kept(".glb"), 2U);
  std::ofstream(folder_ / "heads/a.obj.points") << "";
  EXPECT_THROW(Make(), std::runtime_error) << "of its points none is left";
}

TEST_F(HeadCacheTest, AFileThatTheHeadNamesIsWatchedWhetherItIsThereOrNot) {
  std::ofstream(folder_ / "heads/a.obj", std::ios::app) << "mtllib skins/a.mtl\n";
  const std::size_t vertices = Make().vertices;
  const auto other = MakeHead("pygmalion");
  const auto replace = [&] {
    std::ofstream(OnlyKept(), std::ios::binary) << WriteAsset(*other, {});
    return Make().vertices == other->rig().data().rest.size();
  };
  EXPECT_TRUE(replace()) << "nothing has changed";
  std::filesystem::create_directory(folder_ / "heads/skins");
  std::ofstream(folder_ / "heads/skins/a.mtl") << "newmtl skin\n";
  EXPECT_EQ(Make().vertices, vertices);
  EXPECT_TRUE(replace());
  std::ofstream(folder_ / "heads/skins/a.mtl", std::ios::app) << "Kd 1 0 0\n";
  EXPECT_EQ(Make().vertices, vertices);
  EXPECT_EQ(Kept(".glb"), 1U);
}

TEST_F(HeadCacheTest, ADamagedOneIsToldAndBakedAnew) {
  const std::size_t vertices = Make().vertices;
  std::filesystem::resize_file(OnlyKept(), 1000);
  const Made again = Make();
  EXPECT_EQ(again.vertices, vertices);
  EXPECT_NE(again.said.find("baked anew"), std::string::npos) << again.said;
  EXPECT_EQ(Make().said.find("baked anew"), std::string::npos) << "it has been kept again";
}

TEST_F(HeadCacheTest, OnlyTheLastHeadsAreKept) {
  // What is somebody's own in the folder stays.
  std::filesystem::create_directories(cache_);
  for (int i = 0; i < 40; ++i) {
    const std::string own = cache_ + "/0123456789abcd" + std::to_string(10 + i);
    std::ofstream(own + ".txt") << "mine";
    std::ofstream(own + ".glb") << "mine";
    std::filesystem::last_write_time(own + ".txt", std::filesystem::file_time_type::min());
  }
  for (std::size_t i = 0; i < HeadCache::kMaxHeads + 3; ++i) {
    WriteHead("a.obj", static_cast<int>(1000 + i));
    std::filesystem::last_write_time(folder_ / "heads/a.obj",
                                     std::filesystem::file_time_type(std::chrono::seconds(i)));
    Make();
  }
  EXPECT_EQ(Kept(".glb"), HeadCache::kMaxHeads + 40);
  EXPECT_EQ(Kept(".txt"), HeadCache::kMaxHeads + 40);
}

TEST_F(HeadCacheTest, HalvesOfHeadsThatWereLeftAreDropped) {
  Make();
  const std::string name = std::filesystem::path(OnlyKept()).filename().string();
  for (int i = 0; i < 40; ++i) {
    std::ofstream(cache_ + "/" + std::to_string(10 + i) + name.substr(2)) << "cut";
  }
  WriteHead("b.obj", 2);
  Make("b.obj");
  EXPECT_LE(Kept(".glb"), HeadCache::kMaxHeads);
}

TEST_F(HeadCacheTest, WhereNothingCanBeKeptTheHeadIsThereAllTheSame) {
  std::ofstream(folder_ / "file") << "in the way";
  cache_ = folder_ / "file";
  const Made made = Make();
  EXPECT_GT(made.vertices, 3U);
  EXPECT_NE(made.said.find("the head is not kept"), std::string::npos) << made.said;
}

}  // namespace
}  // namespace fsm
