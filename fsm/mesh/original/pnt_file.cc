#include "fsm/mesh/original/pnt_file.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "fsm/base/parse_number.h"
#include "fsm/base/words.h"
#include "vm_protocol/core/text_file.h"

namespace fsm {
namespace {

constexpr int kMaxName = 9999;

/// Reads lines of numbers, ended by LF, CR or both.
class NumberLines {
 public:
  NumberLines(const std::string& name, std::string_view text) : name_(name), text_(text) {}

  /// Reads the header, `#N` with N one more than there are records, and calls `read` with the
  /// words of each record, a line; `what` says what they are. Ends at the first error.
  template <typename Read>
  vm::Result<void> ReadRecords(const std::string& what, const Read& read) {
    const auto words = Next();
    const auto header = words.size() == 1 && words[0].front() == '#'
                            ? ParseNumber<int>(words[0].substr(1))
                            : std::nullopt;
    if (!header || *header < 1) {
      line_ = std::max(line_, 1);
      return Fail("#N expected, one more than the number of " + what);
    }
    const auto count = static_cast<std::size_t>(*header - 1);
    if (count >= kMaxWireframe) {
      return vm::Fail(vm::Errc::kLimit, name_ + ": at most " + std::to_string(kMaxWireframe) + " " +
                                            what + " are read");
    }
    for (std::size_t i = 0; i < count; ++i) {
      const auto record = Next();
      if (record.empty()) {
        return Fail("it ends after " + std::to_string(i) + " of " + std::to_string(count) + " " +
                    what);
      }
      if (vm::Result<void> done = read(record); !done) return done;
    }
    if (Next().empty()) return {};
    return Fail("the header announces " + std::to_string(count) + " " + what + ", but more follow");
  }

  std::unexpected<vm::Error> Fail(const std::string& text) const {
    return vm::Fail(vm::Errc::kBadValue, name_ + ":" + std::to_string(line_) + ": " + text);
  }

 private:
  /// Returns the words of the next line that has any; empty at the end.
  std::vector<std::string_view> Next() {
    constexpr std::size_t kMaxWords = 13;
    std::vector<std::string_view> words;
    while (words.empty() && !text_.empty()) {
      ++line_;
      const char* const begin = text_.data();
      words = WordsOf(ReadUntil("\r\n", text_), kMaxWords);
      const bool ended_by_cr = text_.data() != begin && text_.data()[-1] == '\r';
      if (ended_by_cr && text_.starts_with('\n')) text_.remove_prefix(1);
    }
    return words;
  }

  const std::string& name_;
  std::string_view text_;
  int line_ = 0;
};

bool IsWhole(std::string_view word) { return ParseNumber<int>(word).has_value(); }

bool ReadReal(std::string_view word, float& out) {
  const auto number = ParseNumber<float>(word);
  out = number.value_or(0);
  return number && std::abs(out) < 1e6f;
}

bool ReadName(std::string_view group, std::string_view number, PointName& out) {
  const auto first = ParseNumber<int>(group), second = ParseNumber<int>(number);
  out = {first.value_or(0), second.value_or(0)};
  return out.first > 0 && out.second > 0 && out.first <= kMaxName && out.second <= kMaxName;
}

std::string Shown(std::span<const std::string_view> words) {
  std::string line;
  for (const auto word : words) line += (line.empty() ? "" : " ") + std::string(word);
  if (line.size() > 60) line = line.substr(0, 60) + "...";
  for (char& c : line) {
    if (c < ' ' || c > '~') c = '?';
  }
  return "'" + line + "'";
}

}  // namespace

std::string InWords(const PointName& point) {
  return "point " + std::to_string(point.second) + " of group " + std::to_string(point.first);
}

vm::Result<PntFile> ParsePnt(const std::string& name, std::string_view text) {
  NumberLines lines(name, text);
  PntFile file;
  const auto read = lines.ReadRecords("points", [&](const auto& words) -> vm::Result<void> {
    PointName point;
    glm::vec3 at;
    if (words.size() != 6 || !IsWhole(words[0]) || !ReadName(words[1], words[2], point) ||
        !ReadReal(words[3], at.x) || !ReadReal(words[4], at.y) || !ReadReal(words[5], at.z)) {
      return lines.Fail("INDEX GROUP NUMBER X Y Z expected, not " + Shown(words));
    }
    if (!file.index.emplace(point, file.positions.size()).second) {
      return lines.Fail(InWords(point) + " is there twice");
    }
    file.names.push_back(point);
    file.positions.push_back(at);
    return {};
  });
  if (!read) return std::unexpected(read.error());
  return file;
}

vm::Result<LnkFile> ParseLnk(const std::string& name, std::string_view text) {
  NumberLines lines(name, text);
  LnkFile file;
  const auto read = lines.ReadRecords("triangles", [&](const auto& words) -> vm::Result<void> {
    LnkFile::Triangle triangle{};
    PointName own;
    bool good = words.size() == 9 && IsWhole(words[0]) && ReadName(words[1], words[2], own);
    for (std::size_t k = 0; good && k < 3; ++k) {
      good = ReadName(words[3 + 2 * k], words[4 + 2 * k], triangle.corner[k]);
    }
    if (!good) {
      return lines.Fail("INDEX GROUP NUMBER and three corners GROUP NUMBER expected, not " +
                        Shown(words));
    }
    triangle.group = own.first;
    file.triangles.push_back(triangle);
    return {};
  });
  if (!read) return std::unexpected(read.error());
  return file;
}

vm::Result<PntFile> ReadPnt(const std::string& path) {
  const auto text = vm::ReadTextFile(path, kMaxPntBytes);
  if (!text) return std::unexpected(text.error());
  return ParsePnt(path, *text);
}

vm::Result<LnkFile> ReadLnk(const std::string& path) {
  const auto text = vm::ReadTextFile(path, kMaxPntBytes);
  if (!text) return std::unexpected(text.error());
  return ParseLnk(path, *text);
}

}  // namespace fsm
