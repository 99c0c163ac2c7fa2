#pragma once

#include <memory>
#include <optional>
#include <string>

#include "task_manager/grammar/model.h"

namespace vxml {

/// A grammar that nobody wrote out: of a choice, an option, keys or the platform's own words.
struct Phrase {
  static constexpr std::size_t kMostApproximate = 50;

  std::string words{};  ///< or keys
  bool dtmf = false;
  /// Any of the words, in order, at least one. Of more than kMostApproximate words all are wanted:
  /// such a grammar grows with the square of their number.
  bool approximate = false;
  std::optional<std::string> value{};  ///< what it means, if that is not the words

  /// The same for phrases that make the same grammar, different for others.
  std::string Key() const;
};

/// Its root rule is called "phrase".
std::unique_ptr<srgs::Grammar> MakeGrammar(const Phrase& phrase);

}  // namespace vxml
