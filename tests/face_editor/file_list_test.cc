#include "face_editor/core/file_list.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace editor {
namespace {

namespace fs = std::filesystem;

class FileListTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = testing::TempDir() + "/files_XXXXXX";
    ASSERT_NE(mkdtemp(folder_.data()), nullptr);
    fs::create_directory(folder_ + "/zoo");
    fs::create_directory(folder_ + "/.hidden");
    for (const char* name :
         {"b.JPG", "a.png", "head.GLB", "units.txt", "film.mp4", ".secret.png"}) {
      std::ofstream(folder_ + "/" + name) << "abc";
    }
    fs::create_symlink("/nowhere/at/all.png", folder_ + "/link.png");
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string Names(FileKind kind, bool all = false) {
    const auto files = ListFiles(folder_, kind, all);
    if (!files) return files.error().text;
    std::string names;
    for (const auto& file : *files) names += file.name + (file.folder ? "/ " : " ");
    return names;
  }
  std::string folder_;
};

TEST_F(FileListTest, FoldersComeFirstAndOnlyTheKindAskedForFollows) {
  EXPECT_EQ(Names(FileKind::kPhoto), "zoo/ a.png b.JPG link.png ");
  EXPECT_EQ(Names(FileKind::kTable), "zoo/ units.txt ");
  EXPECT_EQ(Names(FileKind::kFolder), "zoo/ ");
  EXPECT_EQ(Names(FileKind::kPhotoOrHead), "zoo/ a.png b.JPG head.GLB link.png units.txt ");
  EXPECT_EQ(Names(FileKind::kTable, true),
            ".hidden/ zoo/ .secret.png a.png b.JPG film.mp4 head.GLB link.png units.txt ");
}

TEST_F(FileListTest, AFolderThatCannotBeReadIsNamed) {
  const auto files = ListFiles(folder_ + "/none", FileKind::kPhoto, false);
  ASSERT_FALSE(files);
  EXPECT_EQ(files.error().code, vm::Errc::kUnavailable);
  EXPECT_TRUE(files.error().text.starts_with("cannot read the folder '" + folder_ + "/none': "))
      << files.error().text;
  EXPECT_FALSE(ListFiles(folder_ + "/a.png", FileKind::kPhoto, false));
}

TEST_F(FileListTest, PathsAreTakenFromTheFolderShown) {
  EXPECT_EQ(WholePath("/a/b", "c.png"), "/a/b/c.png");
  EXPECT_EQ(WholePath("/a/b", "../c/./d"), "/a/c/d");
  EXPECT_EQ(WholePath("/a/b", ".."), "/a");
  EXPECT_EQ(WholePath("/", ".."), "/");
  EXPECT_EQ(WholePath("/a", "/c.png"), "/c.png");
  EXPECT_EQ(WholePath("/a/b/", "."), "/a/b");
  EXPECT_EQ(WholePath("/a", "~/x"), std::string(std::getenv("HOME")) + "/x");
  EXPECT_EQ(WholePath("", "x"), fs::current_path().string() + "/x");
}

}  // namespace
}  // namespace editor
