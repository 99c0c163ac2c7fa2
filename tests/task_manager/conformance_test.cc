#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>

#include "tests/task_manager/case_file.h"

namespace vxml_test {
namespace {

const std::vector<Case>& Cases() {
  static const std::vector<Case> cases =
      ReadCases(GALATEA_SOURCE_DIR "/tests/task_manager/conformance");
  return cases;
}

std::map<std::string, std::string>& Results() {
  static std::map<std::string, std::string> results;
  return results;
}

/// Writes the table when the whole suite ran in this process.
class TableWriter : public ::testing::Environment {
 public:
  void TearDown() override {
    if (Results().size() != Cases().size()) return;
    std::map<std::string, int> totals;
    std::string table;
    for (const Case& each : Cases()) {
      const std::string& result = Results()[each.name];
      ++totals[result];
      table +=
          "| " + each.section + " | `" + each.name + "` | " + each.text + " | " + result + " |\n";
    }
    std::string text =
        "# Conformance\n\nWritten by the test run (`task_manager_test "
        "--gtest_filter='*Conformance*'`) from the documents in\n"
        "`tests/task_manager/conformance/`, one per assertion. Sections are those of VoiceXML 2.0; "
        "2.1 stands in front of those of\nVoiceXML 2.1, S of SRGS 1.0 and SISR 1.0, G of "
        "Galatea's own markup.\n\n";
    for (const char* kind : {"pass", "fail", "not implemented"}) {
      text += std::string("- ") + kind + ": " + std::to_string(totals[kind]) + "\n";
    }
    text += "\n| section | document | assertion | result |\n| --- | --- | --- | --- |\n" + table;
    const char* path = GALATEA_SOURCE_DIR "/docs/reference/conformance.md";
    std::ifstream in(path);
    const std::string old{std::istreambuf_iterator<char>(in), {}};
    if (old != text) std::ofstream(path) << text;
  }
};

const auto* const kWriter = ::testing::AddGlobalTestEnvironment(new TableWriter);

class Conformance : public ::testing::TestWithParam<std::size_t> {};

TEST_P(Conformance, DocumentDoesWhatItsSectionSays) {
  const Case& the_case = Cases()[GetParam()];
  const Outcome outcome = RunCase(the_case);
  Results()[the_case.name] = outcome.pass               ? "pass"
                             : the_case.not_implemented ? "not implemented"
                                                        : "fail";
  if (the_case.not_implemented) {
    EXPECT_FALSE(outcome.pass) << the_case.name << " works: take its mark away";
    return;
  }
  EXPECT_TRUE(outcome.pass) << the_case.name << ": " << the_case.text << "\n"
                            << outcome.why << "\n"
                            << outcome.transcript;
}

INSTANTIATE_TEST_SUITE_P(Documents, Conformance, ::testing::Range(std::size_t{0}, Cases().size()),
                         [](const auto& instance) {
                           std::string name = Cases()[instance.param].name;
                           for (char& c : name) {
                             if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
                           }
                           return name;
                         });

TEST(ConformanceSuite, NamesAreUniqueAndTheSuiteIsLarge) {
  std::map<std::string, int> names;
  for (const Case& each : Cases()) EXPECT_EQ(++names[each.name], 1) << each.name;
  EXPECT_GE(names.size(), 300U);
}

}  // namespace
}  // namespace vxml_test
