#include "fsm/mesh/pnt_file.h"

#include <cmath>
#include <span>

#include "fsm/base/parse_number.h"
#include "fsm/base/words.h"
#include "vm_protocol/core/text_file.h"

namespace fsm {
namespace {

constexpr std::size_t kMaxFileBytes = 4U << 20;
constexpr int kMaxName = 9999;

/// Lines of numbers; ended by LF, CR or both.
class NumberLines {
 public:
  NumberLines(const std::string& name, std::string_view text) : name_(name), text_(text) {}

  /// The words of the next line that has any; none at the end.
  std::vector<std::string_view> Next() {
    std::vector<std::string_view> words;
    while (words.empty() && !text_.empty()) {
      ++line_;
      const char* const begin = text_.data();
      words = WordsOf(TakeUntil("\r\n", text_), kMaxWords);
      const bool ended_by_cr = text_.data() != begin && text_.data()[-1] == '\r';
      if (ended_by_cr && text_.starts_with('\n')) text_.remove_prefix(1);
    }
    return words;
  }

  std::unexpected<vm::Error> Wrong(const std::string& text) const {
    return vm::Fail(vm::Errc::kBadValue, name_ + ":" + std::to_string(line_) + ": " + text);
  }

  /// `#N` of the first line: one more than there are records.
  vm::Result<std::size_t> Header(const char* what) {
    const auto words = Next();
    int count = 0;
    if (words.size() != 1 || words[0].front() != '#' || !Whole(words[0].substr(1), count) ||
        count < 1) {
      if (line_ == 0) line_ = 1;
      return Wrong(std::string("#N expected, one more than the number of ") + what);
    }
    if (static_cast<std::size_t>(count) > kMaxWireframe) {
      return vm::Fail(vm::Errc::kLimit, name_ + ": at most " + std::to_string(kMaxWireframe) + " " +
                                            what + " are read");
    }
    return static_cast<std::size_t>(count - 1);
  }

  static bool Whole(std::string_view word, int& out) {
    const auto number = ParseNumber<int>(word);
    out = number.value_or(0);
    return number.has_value();
  }
  static bool Real(std::string_view word, float& out) {
    const auto number = ParseNumber<float>(word);
    out = number.value_or(0);
    return number && std::abs(out) < 1e6F;
  }
  static bool Name(std::string_view group, std::string_view number, PointName& out) {
    return Whole(group, out.first) && Whole(number, out.second) && out.first > 0 &&
           out.second > 0 && out.first <= kMaxName && out.second <= kMaxName;
  }

 private:
  static constexpr std::size_t kMaxWords = 13;

  const std::string& name_;
  std::string_view text_;
  int line_ = 0;
};

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
  const auto count = lines.Header("points");
  if (!count) return std::unexpected(count.error());
  PntFile file;
  for (std::size_t i = 0; i < *count; ++i) {
    const auto words = lines.Next();
    if (words.empty()) {
      return lines.Wrong("it ends after " + std::to_string(i) + " of " + std::to_string(*count) +
                         " points");
    }
    PointName point;
    glm::vec3 at;
    int index = 0;
    if (words.size() != 6 || !NumberLines::Whole(words[0], index) ||
        !NumberLines::Name(words[1], words[2], point) || !NumberLines::Real(words[3], at.x) ||
        !NumberLines::Real(words[4], at.y) || !NumberLines::Real(words[5], at.z)) {
      return lines.Wrong("INDEX GROUP NUMBER X Y Z expected, not " + Shown(words));
    }
    if (!file.index.emplace(point, file.at.size()).second) {
      return lines.Wrong(InWords(point) + " is there twice");
    }
    file.names.push_back(point);
    file.at.push_back(at);
  }
  if (const auto more = lines.Next(); !more.empty()) {
    return lines.Wrong("the header announces " + std::to_string(*count) +
                       " points, but more follow");
  }
  return file;
}

vm::Result<LnkFile> ParseLnk(const std::string& name, std::string_view text) {
  NumberLines lines(name, text);
  const auto count = lines.Header("triangles");
  if (!count) return std::unexpected(count.error());
  LnkFile file;
  for (std::size_t i = 0; i < *count; ++i) {
    const auto words = lines.Next();
    if (words.empty()) {
      return lines.Wrong("it ends after " + std::to_string(i) + " of " + std::to_string(*count) +
                         " triangles");
    }
    LnkFile::Triangle triangle{};
    PointName own;
    int index = 0;
    bool good = words.size() == 9 && NumberLines::Whole(words[0], index) &&
                NumberLines::Name(words[1], words[2], own);
    for (std::size_t k = 0; good && k < 3; ++k) {
      good = NumberLines::Name(words[3 + 2 * k], words[4 + 2 * k], triangle.corner[k]);
    }
    if (!good) {
      return lines.Wrong("INDEX GROUP NUMBER and three corners GROUP NUMBER expected, not " +
                         Shown(words));
    }
    triangle.group = own.first;
    file.triangles.push_back(triangle);
  }
  if (const auto more = lines.Next(); !more.empty()) {
    return lines.Wrong("the header announces " + std::to_string(*count) +
                       " triangles, but more follow");
  }
  return file;
}

vm::Result<PntFile> ReadPnt(const std::string& path) {
  const auto text = vm::ReadTextFile(path, kMaxFileBytes);
  if (!text) return std::unexpected(text.error());
  return ParsePnt(path, *text);
}

vm::Result<LnkFile> ReadLnk(const std::string& path) {
  const auto text = vm::ReadTextFile(path, kMaxFileBytes);
  if (!text) return std::unexpected(text.error());
  return ParseLnk(path, *text);
}

}  // namespace fsm
