// The real program on the virtual clock: bad input is one clear error, and the next request works.

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "srm/engine/decoder.h"
#include "tests/support/process.h"

namespace {

class ProgramTest : public testing::Test {
 protected:
  void SetUp() override {
    if (access((srm::PocketsphinxOptions().model + "/cmudict-en-us.dict").c_str(), R_OK) != 0) {
      GTEST_SKIP() << "the model is not installed (pocketsphinx-en-us)";
    }
    ear_ = std::make_unique<support::Process>(
        std::vector<std::string>{GALATEA_BIN_DIR "/srm", "--clock", "virtual"});
    ear_->WriteLine("prop Error = AutoOutput");
  }
  std::string Write(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  /// The error that a line is answered with.
  std::string ErrorOf(const std::string& line) {
    ear_->WriteLine(line);
    return ear_->Expect(".error = ").value_or("(none)\n" + ear_->Seen());
  }
  const support::TempDir folder_;
  std::unique_ptr<support::Process> ear_;
};

/// A WAV header that promises `promised` bytes of 16 kHz mono, and `given` bytes of silence.
std::string Wav(std::uint32_t promised, std::size_t given) {
  const auto number = [](std::uint32_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i) & 0xFF);
    return text;
  };
  return "RIFF" + number(promised + 36, 4) + "WAVEfmt " + number(16, 4) + number(1, 2) +
         number(1, 2) + number(16000, 4) + number(32000, 4) + number(2, 2) + number(16, 2) +
         "data" + number(promised, 4) + std::string(given, '\0');
}

TEST_F(ProgramTest, BadSourcesAreNamed) {
  EXPECT_NE(ErrorOf("set Input = wav:/nowhere.wav").find("cannot read '/nowhere.wav'"),
            std::string::npos);
  const std::string text = Write("text.wav", "this is no sound");
  EXPECT_NE(ErrorOf("set Input = wav:" + text).find("cannot read '" + text), std::string::npos);
  const std::string empty = Write("empty.wav", Wav(0, 0));
  EXPECT_NE(ErrorOf("set Input = wav:" + empty).find("has no sound in it"), std::string::npos);
  EXPECT_NE(ErrorOf("set Input = raw:/dev/null").find("needs the real clock"), std::string::npos);
  EXPECT_NE(ErrorOf("set Input = telephone").find("expected NONE, wav:PATH"), std::string::npos);
}

TEST_F(ProgramTest, BadGrammarsAreNamedWithTheirLine) {
  const std::string jsgf = Write("g.jsgf", "#JSGF V1.0;\ngrammar g;\npublic <a> = <b>;\n");
  EXPECT_NE(ErrorOf("set Grammar.file = g " + jsgf).find("g.jsgf: line 3: there is no rule 'b'"),
            std::string::npos);
  const std::string left = Write("l.gram", "$a = $a x | y\n$a\n");
  EXPECT_NE(ErrorOf("set Grammar.file = g " + left).find("rule 'a' begins with itself"),
            std::string::npos);
}

TEST_F(ProgramTest, NamedPipesInLinesAreRefusedAndItGoesOn) {
  const std::string pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string line : {"save mine << ", "do ", "set Input = wav:", "set Grammar.load < ",
                                 "set Grammar.file = g "}) {
    const std::string error = ErrorOf(line + pipe);
    EXPECT_NE(error.find("'" + pipe + "' is not a regular file"), std::string::npos) << error;
  }
  EXPECT_NE(ErrorOf("set Listen.keep = " + pipe).find("is no folder"), std::string::npos);
  ear_->WriteLine("set#1 Listen.timeout = 500");
  EXPECT_TRUE(ear_->Expect("rep#1 Listen.timeout = 500"));
}

TEST_F(ProgramTest, ALyingHeaderAndSilenceDoNoHarmAndTheNextRequestWorks) {
  const std::string lying = Write("lying.wav", Wav(0x7FFFFFFF, 32000));
  ear_->WriteLine("set Grammar.load = g yes | no");
  ear_->WriteLine("set Grammar = g");
  ear_->WriteLine("set Listen.timeout = 500");
  ear_->WriteLine("set Run = START");
  ear_->WriteLine("set Input = wav:" + lying);
  EXPECT_TRUE(ear_->Expect("rep NoInput = 500")) << ear_->Seen();
  EXPECT_TRUE(ear_->Expect("rep Input = NONE")) << ear_->Seen();
  ear_->WriteLine("set Input.text = yes");
  EXPECT_TRUE(ear_->Expect("rep Result = yes")) << ear_->Seen();
}

}  // namespace
