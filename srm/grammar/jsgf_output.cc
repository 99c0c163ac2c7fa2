#include "srm/grammar/jsgf_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace srm {
namespace {

using ear::Grammar;
using ear::kUnlimited;
using ear::Node;
using Kind = Node::Kind;

class Writer {
 public:
  Writer(std::size_t index, const Grammar& grammar) : index_(index), grammar_(grammar) {
    for (const auto& [name, node] : grammar.rules()) numbers_.emplace(name, numbers_.size());
  }

  std::string Rules() {
    std::string text;
    for (const auto& [name, node] : grammar_.rules()) {
      text += "<" + Name(name) + "> = " + Text(node) + " ;\n";
    }
    return text;
  }
  std::string RootName() { return Name(grammar_.root()); }

 private:
  /// Rules of several grammars must not meet, and may have any name.
  std::string Name(std::string_view name) const {
    return fmt::format("g{}_{}", index_, numbers_.at(name));
  }

  std::string Text(const Node& node) {
    switch (node.kind) {
      case Kind::kWord:
        return node.text;
      case Kind::kAny:
        return "<any>";
      case Kind::kRule:
        return "<" + Name(node.text) + ">";
      case Kind::kTag:
        return "<NULL>";
      case Kind::kVoid:
        return "<VOID>";
      case Kind::kSequence: {
        std::string text;
        for (const Node& part : node.parts) {
          // The engine loses its way at an empty step inside a phrase, so tags leave nothing.
          const std::string one = Text(part);
          if (one != "<NULL>") text += (text.empty() ? "" : " ") + one;
        }
        return text.empty() ? "<NULL>" : "( " + text + " )";
      }
      case Kind::kChoice: {
        std::string text;
        for (std::size_t i = 0; i < node.parts.size(); ++i) {
          text += fmt::format("{}/{}/ {}", i == 0 ? "" : " | ",
                              i < node.weights.size() ? node.weights[i] : 1.0, Text(node.parts[i]));
        }
        return "( " + text + " )";
      }
      case Kind::kRepeat:
        return Repeat(node);
    }
    return "<NULL>";
  }

  std::string Repeat(const Node& node) {
    const std::string once = Text(node.parts[0]);
    std::string text;
    for (int i = 0; i < node.least; ++i) text += once + " ";
    if (node.most == kUnlimited) return "( " + text + "( " + once + " )* )";
    std::string rest;
    for (int i = node.least; i < node.most; ++i) {
      rest = rest.empty() ? "[ " + once + " ]" : "[ " + once + " " + rest + " ]";
    }
    return "( " + (text + rest).append(text.empty() && rest.empty() ? "<NULL>" : "") + " )";
  }

  const std::size_t index_;
  const Grammar& grammar_;
  std::map<std::string_view, std::size_t> numbers_;
};

/// Rows of parts that may be left out, in a piece of a grammar.
struct Rows {
  bool empty = true;        ///< the whole piece may be left out: a row of `through`
  std::size_t through = 0;  ///< else 0
  std::size_t head = 0, tail = 0, longest = 0;

  void Append(const Rows& next) {
    longest = std::max({longest, next.longest, tail + next.head});
    if (empty) head = std::max(head, through + next.head);
    tail = next.empty ? std::max(next.tail, tail + next.through) : next.tail;
    empty = empty && next.empty;
    through = empty ? through + next.through : 0;
  }
  void Or(const Rows& other) {
    empty = empty || other.empty;
    through = std::max(through, other.through);
    head = std::max(head, other.head);
    tail = std::max(tail, other.tail);
    longest = std::max(longest, other.longest);
  }
  void MakeOptional() { Or({.empty = true, .through = 1, .head = 1, .tail = 1, .longest = 1}); }
};

class RowFinder {
 public:
  explicit RowFinder(const Grammar& grammar) : grammar_(grammar) {}

  Rows Of(const Node& node) {
    Rows rows;
    switch (node.kind) {
      case Kind::kWord:
      case Kind::kAny:
      case Kind::kVoid:
        rows.empty = false;
        break;
      case Kind::kTag:
        break;
      case Kind::kRule:
        if (std::find(path_.begin(), path_.end(), node.text) != path_.end()) {
          rows.empty = false;
          break;
        }
        path_.push_back(node.text);
        rows = Of(grammar_.rules().find(node.text)->second);
        path_.pop_back();
        break;
      case Kind::kSequence:
        for (const Node& part : node.parts) rows.Append(Of(part));
        break;
      case Kind::kChoice:
        rows.empty = false;
        for (const Node& part : node.parts) rows.Or(Of(part));
        break;
      case Kind::kRepeat: {
        Rows once = Of(node.parts[0]);
        for (int i = 0; i < node.least; ++i) rows.Append(once);
        once.MakeOptional();
        const int most = node.most == kUnlimited ? node.least + 1 : node.most;
        for (int i = node.least; i < most; ++i) rows.Append(once);
        break;
      }
    }
    return rows;
  }

 private:
  const Grammar& grammar_;
  std::vector<std::string_view> path_;
};

}  // namespace

std::size_t LongestOptionalRow(const Grammar& grammar) {
  return RowFinder(grammar).Of(grammar.rules().find(grammar.root())->second).longest;
}

const std::vector<std::string>& ModelPhonemes() {
  static const std::vector<std::string> names = {
      "AA", "AE", "AH", "AO", "AW", "AY", "B",  "CH", "D", "DH", "EH", "ER", "EY",
      "F",  "G",  "HH", "IH", "IY", "JH", "K",  "L",  "M", "N",  "NG", "OW", "OY",
      "P",  "R",  "S",  "SH", "T",  "TH", "UH", "UW", "V", "W",  "Y",  "Z",  "ZH"};
  return names;
}

std::string ToJsgf(const std::vector<const Grammar*>& grammars) {
  std::string rules, roots;
  bool any = false;
  for (std::size_t i = 0; i < grammars.size(); ++i) {
    Writer writer(i, *grammars[i]);
    rules += writer.Rules();
    roots += (roots.empty() ? "<" : " | <") + writer.RootName() + ">";
    any = any || grammars[i]->HasAny();
  }
  if (any) {
    // A word of any kind is two to twelve phonemes; the weight keeps it from words that are known.
    std::string one;
    for (const std::string& name : ModelPhonemes()) {
      one += (one.empty() ? "" : " | ") + std::string(kPhonemeWord) + name;
    }
    rules += "<phone> = " + one + " ;\n<any> = <phone> <phone> ( <phone> )* ;\n";
  }
  return "#JSGF V1.0;\ngrammar all;\npublic <all> = " + roots + " ;\n" + rules;
}

}  // namespace srm
