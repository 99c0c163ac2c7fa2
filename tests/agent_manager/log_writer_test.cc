#include "agent_manager/log/log_writer.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "tests/support/process.h"

namespace am {
namespace {

class LogWriterTest : public testing::Test {
 protected:
  static std::string Line(int number) { return "line " + std::to_string(number); }
  /// Everything that was kept, oldest first.
  std::string ReadAllKept(unsigned keep) const {
    std::string text;
    for (unsigned i = keep; i > 0; --i) {
      const std::string packed = path_ + "." + std::to_string(i) + ".gz";
      if (std::filesystem::exists(packed)) text += ReadLog(packed);
    }
    return text + ReadLog(path_);
  }
  support::TempDir folder_;
  std::string path_ = folder_ / "session.log";
  std::string trouble_;
  LogWriter::OnTrouble note_ = [this](const std::string& text) { trouble_ += text + "\n"; };
};

TEST_F(LogWriterTest, NothingIsLostOrDoubledWhenFilesArePutAside) {
  std::string said;
  {
    LogWriter log({.file = path_, .rotate_mb = 1, .keep = 20}, note_);
    for (int i = 0; i < 400000; ++i) {
      log.Write(Line(i));
      said += Line(i) + "\n";
    }
  }
  EXPECT_EQ(ReadAllKept(20), said);
  EXPECT_TRUE(std::filesystem::exists(path_ + ".4.gz")) << "5 MB in files of one";
  EXPECT_FALSE(std::filesystem::exists(path_ + ".1")) << "what was compressed is gone";
  EXPECT_LT(std::filesystem::file_size(path_ + ".1.gz"), 400000u);
  EXPECT_EQ(trouble_, "");
}

TEST_F(LogWriterTest, OnlySoManyOldFilesAreKept) {
  {
    LogWriter log({.file = path_, .rotate_mb = 1, .keep = 2}, note_);
    for (int i = 0; i < 400000; ++i) log.Write(Line(i));
  }
  EXPECT_TRUE(std::filesystem::exists(path_ + ".2.gz"));
  EXPECT_FALSE(std::filesystem::exists(path_ + ".3.gz"));
}

TEST_F(LogWriterTest, ANewStartKeepsWhatWasThereWhereFilesArePutAside) {
  LogWriter({.file = path_, .rotate_mb = 1, .keep = 3}, note_).Write("first");
  LogWriter({.file = path_, .rotate_mb = 1, .keep = 3}, note_).Write("second");
  EXPECT_EQ(ReadAllKept(3), "first\nsecond\n");
  LogWriter({.file = path_}, note_).Write("third");
  EXPECT_EQ(ReadLog(path_), "third\n");
}

TEST_F(LogWriterTest, WhatCannotBePutAsideGrowsOnAndThatIsSaidOnce) {
  std::filesystem::create_directories(path_ + ".1/in the way");
  std::string said = "from before\n";
  std::ofstream(path_) << said;
  {
    LogWriter log({.file = path_, .rotate_mb = 1, .keep = 2}, note_);
    for (int i = 0; i < 300000; ++i) {
      log.Write(Line(i));
      said += Line(i) + "\n";
    }
  }
  EXPECT_EQ(ReadLog(path_), said);
  EXPECT_EQ(std::ranges::count(trouble_, '\n'), 1) << trouble_;
  EXPECT_NE(trouble_.find("cannot be put aside: "), std::string::npos) << trouble_;
  EXPECT_FALSE(std::filesystem::exists(path_ + ".1.gz"));
}

TEST_F(LogWriterTest, AnOldFileThatCannotMoveOnIsNotWrittenOver) {
  std::filesystem::create_directories(path_ + ".2.gz/in the way");
  LogWriter({.file = path_, .rotate_mb = 1, .keep = 2}, note_).Write("first");
  LogWriter({.file = path_, .rotate_mb = 1, .keep = 2}, note_).Write("second");
  LogWriter({.file = path_, .rotate_mb = 1, .keep = 2}, note_).Write("third");
  EXPECT_EQ(ReadLog(path_ + ".1.gz"), "first\n");
  EXPECT_EQ(ReadLog(path_ + ".1"), "second\n");
  EXPECT_NE(trouble_.find("cannot rename '"), std::string::npos) << trouble_;
}

TEST_F(LogWriterTest, AFullDiskLosesLinesAndSaysSo) {
  // A device that is always full.
  LogWriter log({.file = "/dev/full"}, note_);
  for (int i = 0; i < 100; ++i) {
    log.Write(Line(i));
    log.Flush();
  }
  EXPECT_EQ(std::ranges::count(trouble_, '\n'), 1) << "once, not for every line: " << trouble_;
  EXPECT_NE(trouble_.find("cannot be written: No space left"), std::string::npos) << trouble_;
  EXPECT_GT(log.lost(), 500u);
}

TEST_F(LogWriterTest, AnUnreadableOrDamagedLogIsASentence) {
  EXPECT_THROW(ReadLog(folder_ / "none"), std::runtime_error);
  {
    LogWriter log({.file = path_, .rotate_mb = 1, .keep = 1}, note_);
    for (int i = 0; i < 200000; ++i) log.Write(Line(i));
  }
  const std::string packed = path_ + ".1.gz";
  std::fstream file(packed, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(std::filesystem::file_size(packed) / 2));
  file << std::string(100, '\xff');
  file.close();
  EXPECT_THROW(ReadLog(packed), std::runtime_error);
}

}  // namespace
}  // namespace am
