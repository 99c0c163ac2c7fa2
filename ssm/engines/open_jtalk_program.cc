#include "ssm/engines/open_jtalk_program.h"

#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <utility>

#include "ssm/engines/wav_piece.h"
#include "ssm/japanese/kana.h"
#include "ssm/process/child_process.h"

namespace ssm {
namespace {

std::vector<std::string> Fields(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(std::move(field));
  return fields;
}

bool IsPause(const std::string& name) { return name == "sil" || name == "pau"; }

/// The phoneme of a label stands between - and +: "xx^xx-sil+ky=o/A:...". Empty if it does not.
std::string PhonemeOf(const std::string& label) {
  const std::size_t minus = label.find('-');
  const std::size_t plus = label.find('+', minus == std::string::npos ? 0 : minus);
  if (minus == std::string::npos || plus == std::string::npos) return "";
  return label.substr(minus + 1, plus - minus - 1);
}

/// "0 2700000 LABEL": times in 100 ns.
bool TakeLabel(const std::string& line, OpenJtalkAnalysis& analysis) {
  std::istringstream fields(line);
  std::int64_t start = 0, end = 0;
  std::string label;
  if (!(fields >> start >> end >> label) || end < start || end > 36'000'000'000) return false;
  if (PhonemeOf(label).empty()) return false;
  analysis.labels.push_back(std::move(label));
  analysis.ends.emplace_back((end + 5'000) / 10'000);
  return true;
}

vm::Result<std::string> ReadText(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return vm::Fail(vm::Errc::kUnavailable, "cannot read '" + path + "': " + std::strerror(errno));
  }
  return std::string{std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

vm::Result<void> CheckOpenJtalkDictionary(const OpenJtalkOptions& options) {
  if (access((options.dictionary + "/sys.dic").c_str(), R_OK) == 0) return {};
  return vm::Fail(vm::Errc::kUnavailable, "there is no dictionary for open_jtalk in '" +
                                              options.dictionary +
                                              "' (Debian: open-jtalk-mecab-naist-jdic)");
}

vm::Result<OpenJtalkAnalysis> RunOpenJtalk(const OpenJtalkOptions& options, std::string text,
                                           const std::vector<std::string>& arguments,
                                           const std::atomic<bool>& cancelled) {
  const TemporaryFolder folder;
  const std::string trace = folder.File("trace.txt");
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::vector<std::string> argv = {
      options.program, "-x", options.dictionary, "-m", options.voice_file, "-ot", trace};
  argv.insert(argv.end(), arguments.begin(), arguments.end());
  auto ran = RunProgram({.argv = std::move(argv), .input = text + "\n", .limit = options.limit},
                        &cancelled);
  if (!ran) return std::unexpected(ran.error());
  auto read = ReadText(trace);
  if (!read) return std::unexpected(read.error());
  return ParseOpenJtalkTrace(*read);
}

vm::Result<OpenJtalkAnalysis> ParseOpenJtalkTrace(std::string_view trace) {
  OpenJtalkAnalysis analysis;
  enum { kNone, kAnalysis, kLabels } section = kNone;
  std::size_t number = 0;
  std::istringstream lines{std::string(trace)};
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.starts_with('[')) {
      section = line == "[Text analysis result]" ? kAnalysis
                : line == "[Output label]"       ? kLabels
                                                 : kNone;
    } else if (section == kAnalysis && !line.empty()) {
      const auto fields = Fields(line);
      if (fields.size() < 10) continue;
      const std::size_t count = KanaToPhonemes(fields[9]).size();
      if (count > 0) analysis.words.push_back({fields[0], count});
    } else if (section == kLabels && !line.empty() && !TakeLabel(line, analysis)) {
      return vm::Fail(vm::Errc::kBadValue, "trace of open_jtalk, line " + std::to_string(number) +
                                               ": found '" + line.substr(0, 40) +
                                               "', expected START END LABEL");
    }
  }
  return analysis;
}

vm::PhonemeList PhonemesOf(const OpenJtalkAnalysis& analysis, const std::vector<Millis>& ends) {
  assert(ends.size() == analysis.labels.size());
  vm::PhonemeList phonemes;
  Millis before{0};
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (ends[i] <= before) continue;
    phonemes.push_back({PhonemeOf(analysis.labels[i]), ends[i] - before});
    before = ends[i];
  }
  return phonemes;
}

std::vector<WordTime> WordsOf(const OpenJtalkAnalysis& analysis, const vm::PhonemeList& phonemes) {
  std::vector<WordTime> placed;
  std::size_t next = 0;
  Millis at{0};
  const auto step = [&] { at += phonemes[next++].duration; };
  for (const OpenJtalkAnalysis::Word& word : analysis.words) {
    while (next < phonemes.size() && IsPause(phonemes[next].name)) step();
    WordTime time{word.text, at, at};
    for (std::size_t i = 0; i < word.phonemes && next < phonemes.size(); ++i) {
      if (IsPause(phonemes[next].name)) break;
      step();
    }
    time.end = at;
    if (time.end == time.start) break;
    placed.push_back(std::move(time));
  }
  return placed;
}

std::string NumberText(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

}  // namespace ssm
