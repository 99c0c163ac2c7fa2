// What clients of the original say, said to our programs: tests/original_sessions/README.md.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/process.h"

namespace {

using Strings = std::vector<std::string>;

const std::string kSessions = GALATEA_SOURCE_DIR "/tests/original_sessions";

struct Recorded {
  Strings command, said, heard;
};

Recorded Read(const std::filesystem::path& path) {
  Recorded session;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("> ")) session.said.push_back(line.substr(2));
    if (line.starts_with("< ")) session.heard.push_back(line.substr(2));
    if (!line.starts_with("$ ")) continue;
    std::istringstream words(line.substr(2));
    for (std::string word; words >> word;) {
      if (const auto at = word.find("{sessions}"); at != std::string::npos)
        word.replace(at, 10, kSessions);
      session.command.push_back(session.command.empty() ? GALATEA_BIN_DIR "/" + word : word);
    }
  }
  return session;
}

/// `*` in `pattern` stands for any text.
bool Matches(std::string_view text, std::string_view pattern) {
  const std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) return text == pattern;
  if (!text.starts_with(pattern.substr(0, star))) return false;
  for (std::size_t at = star; at <= text.size(); ++at) {
    if (Matches(text.substr(at), pattern.substr(star + 1))) return true;
  }
  return false;
}

/// Each sender's lines in order; what is said at the same instant by two has none. Comings and
/// goings, which @AM tells, are left out.
std::map<std::string, Strings> BySender(const Strings& lines) {
  std::map<std::string, Strings> by_sender;
  for (const std::string& line : lines) {
    if (line.starts_with("From @AM tell ")) continue;
    const bool named = line.starts_with("From @");
    by_sender[named ? line.substr(0, line.find(' ', 5)) : ""].push_back(line);
  }
  return by_sender;
}

Strings Sessions() {
  Strings names;
  for (const auto& entry : std::filesystem::directory_iterator(kSessions)) {
    if (entry.path().extension() == ".session") names.push_back(entry.path().stem());
  }
  std::ranges::sort(names);
  return names;
}

class OriginalSessionTest : public testing::TestWithParam<std::string> {};

TEST_P(OriginalSessionTest, IsAnsweredAsTheOriginalDoes) {
  const Recorded session = Read(kSessions + "/" + GetParam() + ".session");
  ASSERT_FALSE(session.command.empty());
  const support::TempDir folder;
  // am.conf names programs as they are called once installed.
  const std::string path = GALATEA_BIN_DIR ":" + std::string(std::getenv("PATH"));
  support::Process program(session.command, {.cwd = folder.path(), .env = {"PATH=" + path}});
  for (const std::string& line : session.said) program.WriteLine(line);
  program.CloseInput();
  auto heard_by = BySender(program.ReadAll(std::chrono::seconds(60)));
  auto wanted_by = BySender(session.heard);
  EXPECT_EQ(program.Wait(), 0) << program.ErrorText();
  for (const auto& [sender, lines] : heard_by) wanted_by[sender];
  for (const auto& [sender, wanted] : wanted_by) {
    const Strings& heard = heard_by[sender];
    for (std::size_t i = 0; i < std::max(heard.size(), wanted.size()); ++i) {
      ASSERT_LT(i, heard.size()) << "not heard: " << wanted[i];
      ASSERT_LT(i, wanted.size()) << "heard beyond the session: " << heard[i];
      ASSERT_TRUE(Matches(heard[i], wanted[i]))
          << "line " << i + 1 << ": " << heard[i] << "\nexpected: " << wanted[i];
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Of, OriginalSessionTest, testing::ValuesIn(Sessions()),
                         [](const auto& one) { return one.param; });

}  // namespace
