#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace vxml::srgs {

struct Grammar;
struct Rule;

/// A legal rule expansion (SRGS 1.0 section 2): one node of the internal graph both forms compile
/// to.
struct Expansion {
  enum class Kind {
    kToken,
    kSequence,
    kAlternatives,
    kRepeat,
    kReference,
    kTag,
    kNull,
    kVoid,
    kGarbage
  };
  static constexpr int kUnbounded = -1;

  Kind kind = Kind::kSequence;
  std::string text;    ///< token as written; tag content; reference as written
  std::string folded;  ///< token as compared: normalised blanks, no case
  std::string language;
  std::vector<std::unique_ptr<Expansion>> children;
  std::vector<double> weights;  ///< of alternatives, 1 where not given
  int min = 1;                  ///< of repeats
  int max = 1;                  ///< kUnbounded = no end
  std::string uri;              ///< of references: grammar URI without fragment, "" = this grammar
  std::string rule;             ///< of references: rule name, "" = the root
  std::string type;             ///< of references: media type
  std::string phoneme;          ///< the original's token phoneme="..." (Julian phones)
  std::string sym;              ///< the original's token sym="..." (reading)
  std::size_t line = 0;
  std::size_t column = 0;

  // Filled by linking.
  const Rule* target = nullptr;
};

struct Rule {
  std::string name;
  bool is_public = false;
  std::unique_ptr<Expansion> expansion;
  const Grammar* grammar = nullptr;
  std::size_t line = 0;
  std::size_t column = 0;
};

enum class Mode { kVoice, kDtmf };
enum class Form { kXml, kAbnf };

/// A compiled grammar. Immutable once linked. References point into grammars kept by `imports`;
/// grammars that import each other are kept alive by their GrammarStore.
struct Grammar {
  std::string uri;  ///< where it came from, for messages and relative references
  std::string base;
  std::string root;
  std::string language;
  std::string tag_format;
  Mode mode = Mode::kVoice;
  Form form = Form::kXml;
  bool alone = false;         ///< a document judged by the recommendation alone
  bool split_digits = false;  ///< typed figures need no blanks between them (built-in types)
  std::vector<std::string> header_tags;
  std::map<std::string, std::unique_ptr<Rule>> rules;

  const Rule* Find(const std::string& name) const {
    const auto found = rules.find(name);
    return found == rules.end() ? nullptr : found->second.get();
  }
  const Rule* RootRule() const { return root.empty() ? nullptr : Find(root); }
};

}  // namespace vxml::srgs
