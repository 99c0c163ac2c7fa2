#include "tests/task_manager/case_file.h"

#include <unistd.h>

#include <algorithm>
#include <deque>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "task_manager/fetch/uri.h"
#include "task_manager/interpreter/dialog_session.h"
#include "task_manager/platform/text_platform.h"
#include "vm_protocol/xml/node.h"

namespace vxml_test {
namespace {

void Replace(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
    text.replace(at, from.size(), to);
    at += to.size();
  }
}

std::string Whole(std::string body, const std::string& name) {
  if (!name.ends_with(".vxml")) return body;
  Replace(body, "<pass/>", "<exit expr=\"'pass'\"/>");
  Replace(body, "<fail/>", "<exit expr=\"'fail'\"/>");
  const std::string start(vm::xml::Trim(body));
  if (start.starts_with("<?xml") || start.starts_with("<vxml")) return start;
  return "<vxml version=\"2.1\" xmlns=\"http://www.w3.org/2001/vxml\" xml:lang=\"en-US\">\n" +
         body + "</vxml>\n";
}

void ReadFile(const std::filesystem::path& path, std::vector<Case>& cases) {
  std::ifstream in(path);
  std::string line;
  std::string* body = nullptr;
  const std::size_t first = cases.size();
  while (std::getline(in, line)) {
    if (line.starts_with("== ")) {
      Case made;
      made.name = line.substr(3);
      made.section = made.name.substr(0, made.name.find('-'));
      cases.push_back(made);
      body = nullptr;
    } else if (cases.size() == first) {
      continue;  // a head for people
    } else if (line.starts_with("---")) {
      const std::string name = line.size() > 4 ? line.substr(4) : "main.vxml";
      body = &cases.back().files[name];
    } else if (body) {
      *body += line + "\n";
    } else if (line.starts_with("script: ")) {
      std::string script = line.substr(8);
      Replace(script, " ; ", "\n");
      cases.back().script = script;
    } else if (line.starts_with("expect ")) {
      cases.back().expected.push_back(line.substr(7));
    } else if (line == "not implemented") {
      cases.back().not_implemented = true;
    } else if (!line.empty()) {
      cases.back().text += (cases.back().text.empty() ? "" : " ") + line;
    }
  }
  for (std::size_t i = first; i < cases.size(); ++i) {
    if (!cases[i].files.contains("main.vxml")) {
      throw std::runtime_error(path.string() + ": " + cases[i].name + " has no document");
    }
  }
}

/// Values of a string field of all lines of one type, joined by " | ".
std::string FieldsOf(const std::vector<std::string>& lines, const std::string& type,
                     const std::string& field) {
  std::string joined;
  for (const std::string& line : lines) {
    if (line.find("\"type\":\"" + type + "\"") == std::string::npos) continue;
    const std::string key = "\"" + field + "\":";
    const std::size_t at = line.find(key);
    if (at == std::string::npos) continue;
    std::size_t begin = at + key.size();
    std::size_t end = begin;
    if (line[begin] == '"') {
      ++begin;
      for (end = begin; end < line.size() && line[end] != '"'; ++end)
        end += line[end] == '\\' ? 1 : 0;
    } else if (field == "value") {
      end = line.size() - 1;
    } else {
      end = line.find_first_of(",}", begin);
    }
    if (!joined.empty()) joined += " | ";
    joined += line.substr(begin, end - begin);
  }
  return joined;
}

std::string Judge(const std::string& expectation, const std::vector<std::string>& lines) {
  const std::size_t colon = expectation.find(": ");
  const std::string what = expectation.substr(0, colon);
  const std::string wanted = colon == std::string::npos ? "" : expectation.substr(colon + 2);
  std::string found;
  if (what == "exit") {
    found = FieldsOf(lines, "exit", "value");
  } else if (what == "reason") {
    found = FieldsOf(lines, "exit", "reason");
  } else if (what == "prompts") {
    found = FieldsOf(lines, "prompt", "text");
  } else if (what == "log") {
    found = FieldsOf(lines, "log", "text");
  } else if (what == "events") {
    found = FieldsOf(lines, "event", "name");
  } else if (what == "commands") {
    found = FieldsOf(lines, "command", "line");
  } else if (what == "end-ms") {
    found = FieldsOf(lines, "exit", "t");
  } else if (what == "ignored") {
    found = FieldsOf(lines, "ignored", "why");
  } else {
    return "unknown expectation '" + what + "'";
  }
  if (found == wanted) return "";
  return what + ": found '" + found + "', expected '" + wanted + "'";
}

}  // namespace

std::vector<Case> ReadCases(const std::string& folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".cases") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<Case> cases;
  for (const auto& path : paths) ReadFile(path, cases);
  return cases;
}

Outcome RunCase(const Case& the_case) {
  namespace fs = std::filesystem;
  const fs::path folder =
      fs::temp_directory_path() / ("galatea-" + std::to_string(getpid()) + "-" + the_case.name);
  fs::create_directories(folder);
  for (const auto& [name, body] : the_case.files) {
    std::ofstream(folder / name, std::ios::binary) << Whole(body, name);
  }
  Outcome outcome;
  std::vector<std::string> lines;
  auto parsed = vxml::ParseInputScript(the_case.script, "script");
  if (!parsed) {
    outcome.why = parsed.error().text;
    return outcome;
  }
  std::deque<vxml::Command> commands(parsed->begin(), parsed->end());
  vxml::TextPlatform platform(
      [&]() -> std::optional<vxml::Command> {
        if (commands.empty()) return {};
        vxml::Command next = commands.front();
        commands.pop_front();
        return next;
      },
      [&](const std::string& line) { lines.push_back(line); });
  vxml::SessionOptions options;
  options.uri = vxml::fetch::FromPath((folder / "main.vxml").string());
  vxml::DialogSession session(options, platform);
  session.Run();
  fs::remove_all(folder);
  for (const std::string& line : lines) outcome.transcript += line + "\n";
  std::vector<std::string> expected = the_case.expected;
  if (expected.empty()) expected.push_back("exit: pass");
  for (const std::string& expectation : expected) {
    const std::string wrong = Judge(expectation, lines);
    if (!wrong.empty()) outcome.why += (outcome.why.empty() ? "" : "; ") + wrong;
  }
  outcome.pass = outcome.why.empty();
  return outcome;
}

}  // namespace vxml_test
