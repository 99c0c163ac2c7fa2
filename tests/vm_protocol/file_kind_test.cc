#include "vm_protocol/core/file_kind.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include "tests/support/process.h"
#include "vm_protocol/core/text_file.h"

namespace vm {
namespace {

Error Told(const Result<void>& result) { return result ? Error{} : result.error(); }

class FileKindTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    socket_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, (folder_ / "socket").c_str(), sizeof address.sun_path - 1);
    ASSERT_EQ(bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ASSERT_EQ(symlink((folder_ / "pipe").c_str(), (folder_ / "link").c_str()), 0);
    std::ofstream(folder_ / "file") << "12345";
    unfit_ = {folder_ / "pipe", folder_ / "socket", folder_ / "link", "/dev/zero"};
  }
  ~FileKindTest() override { close(socket_); }

  const support::TempDir folder_;
  std::vector<std::string> unfit_;
  int socket_ = -1;
};

TEST_F(FileKindTest, PipesSocketsAndDevicesAreNeitherReadNorWritten) {
  for (const std::string& path : unfit_) {
    const Error expected{Errc::kAccess, "'" + path + "' is not a regular file"};
    EXPECT_EQ(Told(CheckReadable(path)), expected);
    EXPECT_EQ(Told(CheckWritable(path)), expected);
  }
}

TEST_F(FileKindTest, RegularFilesAreFitUpToALimitOfReading) {
  EXPECT_TRUE(CheckReadable(folder_ / "file"));
  EXPECT_TRUE(CheckReadable(folder_ / "file", 5));
  EXPECT_EQ(Told(CheckReadable(folder_ / "file", 4)),
            (Error{Errc::kTooLong, "file '" + (folder_ / "file") + "' is over 4 bytes"}));
  EXPECT_TRUE(CheckWritable(folder_ / "file"));
}

TEST_F(FileKindTest, AMissingFileMayBeWrittenAndIsNotMade) {
  const std::string none = folder_ / "none";
  EXPECT_TRUE(CheckWritable(none));
  EXPECT_EQ(Told(CheckReadable(none)),
            (Error{Errc::kUnavailable, "cannot read '" + none + "': No such file or directory"}));
  const std::string below = folder_ / "file/none";
  EXPECT_EQ(Told(CheckWritable(below)),
            (Error{Errc::kUnavailable, "cannot write '" + below + "': Not a directory"}));
}

TEST_F(FileKindTest, AFolderIsNoFile) {
  const std::string folder = folder_.path();
  EXPECT_EQ(Told(CheckReadable(folder)),
            (Error{Errc::kUnavailable, "cannot read '" + folder + "': Is a directory"}));
  EXPECT_EQ(Told(CheckWritable(folder)),
            (Error{Errc::kUnavailable, "cannot write '" + folder + "': Is a directory"}));
}

TEST_F(FileKindTest, TheNullDeviceMayBeWritten) {
  EXPECT_TRUE(CheckWritable("/dev/null"));
  EXPECT_FALSE(CheckReadable("/dev/null"));
}

TEST_F(FileKindTest, AFileIsReplacedAsAWholeAndNoDraftIsLeft) {
  const std::string file = folder_ / "file";
  {
    auto draft = DraftFile::Beside(file);
    ASSERT_TRUE(draft);
    EXPECT_TRUE(WriteTextFile(file, "new"));
    EXPECT_EQ(ReadTextFile(draft->name(), 9).value(), "") << "each draft has a name of its own";
  }
  EXPECT_EQ(ReadTextFile(file, 9).value(), "new");
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / ".")) {
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
  }
  EXPECT_EQ(Told(WriteTextFile(folder_ / "none/file", "")),
            (Error{Errc::kUnavailable,
                   "cannot write '" + (folder_ / "none/file") + "': No such file or directory"}));
  EXPECT_TRUE(WriteTextFile("/dev/null", "new"));
}

}  // namespace
}  // namespace vm
