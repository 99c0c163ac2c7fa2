#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "task_manager/grammar/model.h"
#include "vm_protocol/core/result.h"
#include "vm_protocol/xml/node.h"

namespace vxml::srgs {

/// Limits of one grammar; over them it is refused.
inline constexpr std::size_t kMaxGrammarBytes = std::size_t{4} << 20;
inline constexpr std::size_t kMaxGrammarDepth = 250;
inline constexpr std::size_t kMaxExpansions = 500'000;  ///< words and other parts, of all together
inline constexpr int kMaxRepeat = 100'000;

/// What surrounds a grammar: its place, and what it inherits where it does not say itself.
struct GrammarContext {
  std::string uri;   ///< of the grammar or the document it stands in, or that refers to it
  std::string base;  ///< relative references are resolved against it
  std::string language;
  Mode mode = Mode::kVoice;
  /// A document by itself: what SRGS 1.0 asks of one is asked for, the header, version, namespace
  /// and language; nothing is inherited and no root guessed, and the shortcuts are no part of it.
  bool alone = false;
};

/// The XML form (SRGS 1.0), from a <grammar> element. Also taken: the Galatea shortcuts (<token>
/// and text directly in <grammar> become the rule "#main" when there is no rule; root="#name";
/// token attributes phoneme and sym).
/// Errors "URI:LINE:COLUMN: ..." with kSyntax, kBadValue, kLimit.
vm::Result<std::unique_ptr<Grammar>> CompileXml(const vm::xml::Node& grammar,
                                                const GrammarContext& context);
/// The ABNF form; the header "#ABNF 1.0 CHARSET;" may be missing in inline grammars.
vm::Result<std::unique_ptr<Grammar>> CompileAbnf(std::string_view text,
                                                 const GrammarContext& context);
/// Either form, told apart by the first character, in any encoding.
vm::Result<std::unique_ptr<Grammar>> CompileBytes(std::string_view bytes,
                                                  const GrammarContext& context,
                                                  const std::string& charset = "");

/// The form that a media type names: application/srgs, application/srgs+xml and their older names,
/// with or without parameters. None: no grammar's type.
std::optional<Form> FormOfType(std::string_view type);

/// A number as weights and probabilities are written: "1", "2.", ".5", "1.0".
bool ParseWeight(std::string_view text, double& value);
/// An XML name without '.', ':' and '-' (SRGS 1.0 section 3.1).
bool IsRuleName(std::string_view name);
bool IsSpecialRule(std::string_view name);  ///< NULL, VOID, GARBAGE
/// A language tag as RFC 3066 writes it: letters, then parts of letters and digits.
bool IsLanguage(std::string_view text);
/// A grammar that has what its surroundings give.
std::unique_ptr<Grammar> MakeGrammar(const GrammarContext& context);
/// The root is there (one rule alone needs no naming, unless the grammar is `alone`), and so is the
/// language of a voice grammar. Errors: kSyntax, without place.
vm::Result<void> CheckHeader(Grammar& grammar, const GrammarContext& context);
/// In a dtmf grammar every token is made of keys (SRGS 1.0 appendix E); the words "star" and
/// "pound" become '*' and '#'.
vm::Result<void> CheckTokens(Grammar& grammar);

std::unique_ptr<Expansion> MakeRepeat(std::unique_ptr<Expansion> what);
/// Sets how often; what holds nothing but tags is taken once at most (SRGS 1.0 section 2.5).
void SetTurns(Expansion& repeat, int min, int max);
/// Sets the turns to what "2", "0-1", "3-" say. False if it is none of these.
bool ParseRepeat(std::string_view text, Expansion& repeat);
/// The same for what ABNF writes between '<' and '>': a repeat, and perhaps /its probability/.
vm::Result<void> ParseRepeatOperator(std::string_view inside, Expansion& repeat);
std::unique_ptr<Expansion> MakeToken(std::string_view text);
/// "grammar.xml#rule" -> the reference's uri and rule.
void SplitReference(const std::string& reference, Expansion& into);

}  // namespace vxml::srgs
