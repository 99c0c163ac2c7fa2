#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vm_protocol/core/result.h"

namespace chat {

/// What is said when something went wrong, by language and trouble: tables/apologies.txt.
class Apologies {
 public:
  /// Errors: kSyntax with FILE:LINE.
  static vm::Result<Apologies> Parse(const std::string& file, std::string_view text);
  /// With its tags; of several in turn. That of English where the language has none; else empty.
  std::string For(const std::string& language, const std::string& trouble);

 private:
  struct Texts {
    std::vector<std::string> texts;
    std::size_t next = 0;
  };
  std::map<std::pair<std::string, std::string>, Texts> texts_;
};

}  // namespace chat
