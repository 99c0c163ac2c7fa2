#pragma once

#include <map>
#include <string>
#include <vector>

namespace vxml_test {

/// One assertion: small documents, what the user does, and what has to happen. The files under
/// conformance/ hold many; their format is described in conformance/README.md.
struct Case {
  std::string section;                       ///< "5.2.4"
  std::string name;                          ///< "5.2.4-highest-count"
  std::string text;                          ///< the assertion
  std::string script;                        ///< input script, one command per line
  std::vector<std::string> expected;         ///< "exit: pass", "prompts: a | b", ...
  std::map<std::string, std::string> files;  ///< "main.vxml" and others
  bool not_implemented = false;
};

/// Throws std::runtime_error naming the file and line.
std::vector<Case> ReadCases(const std::string& folder);

struct Outcome {
  bool pass = false;
  std::string why;
  std::string transcript;
};
/// Runs the case's documents from a folder of its own.
Outcome RunCase(const Case& the_case);

}  // namespace vxml_test
