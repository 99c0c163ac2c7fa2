#include "task_manager/grammar/abnf_scanner.h"

#include <algorithm>

#include "task_manager/grammar/compiler.h"

namespace vxml::srgs {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";
/// What ends an unquoted token.
constexpr std::string_view kTokenEnds = " \t\r\n;=|*+<>(){}[]/!$\"";

}  // namespace

/// Counts on from the place asked for last, so that a whole grammar is counted once.
AbnfScanner::Place AbnfScanner::PlaceOf(std::size_t at) const {
  at = std::min(at, text_.size());
  if (at < counted_to_) {
    counted_to_ = line_start_ = 0;
    line_ = 1;
  }
  while (true) {
    const std::size_t newline = text_.substr(0, at).find('\n', counted_to_);
    if (newline == std::string_view::npos) break;
    counted_to_ = line_start_ = newline + 1;
    ++line_;
  }
  counted_to_ = at;
  return {line_, at - line_start_ + 1};
}

std::unexpected<vm::Error> AbnfScanner::Bad(const std::string& what) const {
  const Place place = PlaceOf(at_);
  return vm::Fail(vm::Errc::kSyntax, std::string(uri_) + ":" + std::to_string(place.line) + ":" +
                                         std::to_string(place.column) + ": " + what);
}

bool AbnfScanner::Looks(std::string_view sign) const {
  return text_.substr(std::min(at_, text_.size())).starts_with(sign);
}

bool AbnfScanner::AtBlank() const {
  return !AtEnd() && kBlanks.find(text_[at_]) != std::string_view::npos;
}

void AbnfScanner::SkipBlank() {
  while (at_ < text_.size()) {
    if (kBlanks.find(text_[at_]) != std::string_view::npos) {
      ++at_;
    } else if (Looks("//")) {
      at_ = std::min(text_.find('\n', at_), text_.size());
    } else if (Looks("/*")) {
      const std::size_t end = text_.find("*/", at_ + 2);
      open_comment_ = end == std::string_view::npos;
      at_ = open_comment_ ? text_.size() : end + 2;
    } else {
      return;
    }
  }
}

bool AbnfScanner::Take(char sign) {
  SkipBlank();
  if (Peek() != sign) return false;
  ++at_;
  return true;
}

std::string AbnfScanner::Word() {
  SkipBlank();
  const std::size_t end = std::min(text_.find_first_of(kTokenEnds, at_), text_.size());
  std::string word(text_.substr(at_, end - at_));
  at_ = end;
  return word;
}

vm::Result<std::string> AbnfScanner::Until(std::string_view close, const std::string& missing) {
  const std::size_t end = text_.find(close, at_);
  if (end == std::string_view::npos) return Bad(missing);
  std::string inside(text_.substr(at_, end - at_));
  at_ = end + close.size();
  return inside;
}

vm::Result<std::string> AbnfScanner::Quoted() {
  SkipBlank();
  const char quote = Peek();
  if (quote != '"' && quote != '\'') return Bad("a string in quotes expected");
  ++at_;
  return Until(std::string_view(&quote, 1), "a string without end");
}

vm::Result<std::string> AbnfScanner::Uri(bool brackets, std::string* type) {
  SkipBlank();
  if (Peek() != '<') {
    if (brackets) return Bad("'<' and a URI expected");
    return Word();
  }
  ++at_;
  auto inside = Until(">", "'>' expected");
  if (!inside) return inside;
  std::string uri(vm::xml::Trim(*inside));
  if (Peek() == '~') {
    ++at_;
    auto media = Uri(brackets);
    if (!media) return media;
    if (type) *type = *media;
  }
  return uri;
}

vm::Result<double> AbnfScanner::Slashed() {
  const AbnfScanner start = *this;
  ++at_;
  auto number = Until("/", "'/' expected after the number");
  if (!number) return std::unexpected(number.error());
  double value = 0;
  if (!ParseWeight(*number, value)) return start.Bad("'" + *number + "' is not a number");
  return value;
}

}  // namespace vxml::srgs
