#pragma once

#include <string>
#include <string_view>

#include "vm_protocol/core/result.h"

namespace vxml::srgs {

/// Reads the pieces of an ABNF grammar (SRGS 1.0 appendix D) from a text one after the other.
/// Lifetime: the text outlives it. Errors are kSyntax, "URI:LINE:COLUMN: ...", at the place
/// reached.
class AbnfScanner {
 public:
  AbnfScanner(std::string_view text, std::string_view uri) : text_(text), uri_(uri) {}

  std::unexpected<vm::Error> Bad(const std::string& what) const;
  bool AtEnd() const { return at_ >= text_.size(); }
  bool OpenComment() const { return open_comment_; }  ///< a comment had no end
  std::size_t line() const { return PlaceOf(at_).line; }
  std::size_t column() const { return PlaceOf(at_).column; }

  bool Looks(std::string_view sign) const;
  char Peek() const { return AtEnd() ? '\0' : text_[at_]; }
  bool AtBlank() const;
  void Skip(std::size_t bytes) { at_ += bytes; }
  /// Blanks and comments.
  void SkipBlank();
  /// The sign, behind blanks. False: something else is there; nothing is taken but the blanks.
  bool Take(char sign);
  /// What stands between blanks and signs; "" if a sign comes first.
  std::string Word();
  /// What stands up to `close`, which is taken too.
  vm::Result<std::string> Until(std::string_view close, const std::string& missing);
  /// A string in single or double quotes.
  vm::Result<std::string> Quoted();
  /// <URI> with an optional ~<media type>. Without `brackets` a bare word will do, as in older
  /// grammars.
  vm::Result<std::string> Uri(bool brackets, std::string* type = nullptr);
  /// /number/
  vm::Result<double> Slashed();

 private:
  struct Place {
    std::size_t line;    ///< from 1
    std::size_t column;  ///< in bytes, from 1
  };
  Place PlaceOf(std::size_t at) const;

  std::string_view text_;
  std::string_view uri_;
  std::size_t at_ = 0;
  bool open_comment_ = false;
  mutable std::size_t counted_to_ = 0;  ///< lines have been counted up to here
  mutable std::size_t line_ = 1;
  mutable std::size_t line_start_ = 0;
};

}  // namespace vxml::srgs
