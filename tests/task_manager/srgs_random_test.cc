// Random grammars of every kind of recursion: what the chart accepts is what a table filled until
// nothing changes accepts, and each parse is one that the grammar gives.
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "task_manager/grammar/matcher.h"
#include "task_manager/grammar/store.h"

namespace vxml::srgs {
namespace {

using Kind = Expansion::Kind;
using Words = std::vector<std::string>;

class GrammarMaker {
 public:
  explicit GrammarMaker(unsigned seed) : random_(seed) {}

  std::string Grammar() {
    std::string text = "#ABNF 1.0;\nlanguage en; root $r0;\n";
    for (int i = 0; i < kRules; ++i) {
      text += "$r" + std::to_string(i) + " = " + Alternatives(3) + ";\n";
    }
    return text;
  }
  Words Input() {
    Words words;
    for (int left = Below(6); left > 0; --left) words.push_back(Word());
    return words;
  }

 private:
  static constexpr int kRules = 3;

  int Below(int end) { return std::uniform_int_distribution<int>(0, end - 1)(random_); }
  std::string Word() { return std::string(1, static_cast<char>('a' + Below(2))); }

  std::string Alternatives(int depth) {
    std::string text = Sequence(depth);
    for (int more = Below(3); more > 0; --more) text += " | " + Sequence(depth);
    return text;
  }
  std::string Sequence(int depth) {
    std::string text = Part(depth);
    for (int more = Below(3); more > 0; --more) text += " " + Part(depth);
    return text;
  }
  std::string Part(int depth) {
    switch (Below(depth > 0 ? 14 : 9)) {
      case 0:
      case 1:
      case 2:
        return Word();
      case 3:
      case 4:
      case 5:
        return "$r" + std::to_string(Below(kRules));
      case 6:
        return "{t" + std::to_string(Below(9)) + "}";
      case 7:
        return Below(2) ? "$NULL" : "()";
      case 8:
        return Below(2) ? "$VOID" : "$GARBAGE";
      case 9:
        return "[" + Alternatives(depth - 1) + "]";
      case 10:
        return "(" + Alternatives(depth - 1) + ")<" + std::to_string(Below(3)) + "->";
      case 11: {
        const int least = Below(3);
        return "(" + Alternatives(depth - 1) + ")<" + std::to_string(least) + "-" +
               std::to_string(least + Below(3)) + ">";
      }
      default:
        return "(" + Alternatives(depth - 1) + ")";
    }
  }

  std::mt19937 random_;
};

/// Which spans of the words each expansion may take, found by filling until nothing changes.
class SpanTable {
 public:
  SpanTable(const Rule& root, const Words& words) : root_(root), words_(words) {
    Collect(*root.expansion);
    while (Fill()) {
    }
  }
  bool Accepts() const { return spans_.at(root_.expansion.get()).contains({0, words_.size()}); }

 private:
  using Spans = std::set<std::pair<std::size_t, std::size_t>>;

  void Collect(const Expansion& node) {
    if (!spans_.try_emplace(&node).second) return;
    for (const auto& child : node.children) Collect(*child);
    if (node.target) Collect(*node.target->expansion);
  }
  bool Fill() {
    bool changed = false;
    for (auto& [node, spans] : spans_) {
      Spans now = Of(*node);
      changed = changed || now != spans;
      spans = std::move(now);
    }
    return changed;
  }
  Spans Empty() const {
    Spans spans;
    for (std::size_t i = 0; i <= words_.size(); ++i) spans.insert({i, i});
    return spans;
  }
  static Spans Joined(const Spans& first, const Spans& second) {
    Spans spans;
    for (const auto& a : first) {
      for (const auto& b : second) {
        if (a.second == b.first) spans.insert({a.first, b.second});
      }
    }
    return spans;
  }
  Spans Of(const Expansion& node) const {
    Spans spans;
    switch (node.kind) {
      case Kind::kToken:
        for (std::size_t i = 0; i < words_.size(); ++i) {
          if (words_[i] == node.text) spans.insert({i, i + 1});
        }
        break;
      case Kind::kTag:
      case Kind::kNull:
        return Empty();
      case Kind::kVoid:
        break;
      case Kind::kGarbage:
        for (std::size_t i = 0; i <= words_.size(); ++i) {
          for (std::size_t j = i; j <= words_.size(); ++j) spans.insert({i, j});
        }
        break;
      case Kind::kReference:
        return spans_.at(node.target->expansion.get());
      case Kind::kAlternatives:
        for (const auto& child : node.children) {
          spans.insert(spans_.at(child.get()).begin(), spans_.at(child.get()).end());
        }
        break;
      case Kind::kSequence:
        spans = Empty();
        for (const auto& child : node.children) spans = Joined(spans, spans_.at(child.get()));
        break;
      case Kind::kRepeat: {
        Spans turns = Empty();
        // Beyond as many turns as there are words nothing new comes.
        const int most = node.max == Expansion::kUnbounded
                             ? node.min + static_cast<int>(words_.size())
                             : node.max;
        for (int turn = 0; turn <= most; ++turn) {
          if (turn >= node.min) spans.insert(turns.begin(), turns.end());
          turns = Joined(turns, spans_.at(node.children[0].get()));
        }
        break;
      }
    }
    return spans;
  }

  const Rule& root_;
  const Words& words_;
  std::map<const Expansion*, Spans> spans_;
};

/// Does the grammar give this parse?
class ParseJudge {
 public:
  bool IsRight(const Parse& parse) {
    const auto ends = From(*parse.rule->expansion, parse.items, 0);
    if (!ends.contains(parse.items.size())) return false;
    for (const ParseItem& item : parse.items) {
      if (item.kind == ParseItem::Kind::kRule && !IsRight(*item.rule)) return false;
    }
    return true;
  }

 private:
  using Items = std::vector<ParseItem>;
  using Ends = std::set<std::size_t>;

  static bool Is(const Items& items, std::size_t at, ParseItem::Kind kind,
                 const std::string& text) {
    return at < items.size() && items[at].kind == kind && items[at].text == text;
  }
  Ends Behind(const Expansion& node, const Items& items, const Ends& from) {
    Ends ends;
    for (const std::size_t at : from) ends.merge(From(node, items, at));
    return ends;
  }
  Ends From(const Expansion& node, const Items& items, std::size_t at) {
    switch (node.kind) {
      case Kind::kToken:
        return Is(items, at, ParseItem::Kind::kToken, node.text) ? Ends{at + 1} : Ends{};
      case Kind::kTag:
        return Is(items, at, ParseItem::Kind::kTag, node.text) ? Ends{at + 1} : Ends{};
      case Kind::kNull:
        return {at};
      case Kind::kVoid:
        return {};
      case Kind::kGarbage:
        if (at < items.size() && items[at].kind == ParseItem::Kind::kGarbage) return {at, at + 1};
        return {at};
      case Kind::kReference: {
        const bool here = at < items.size() && items[at].kind == ParseItem::Kind::kRule &&
                          items[at].rule->rule == node.target;
        return here ? Ends{at + 1} : Ends{};
      }
      case Kind::kAlternatives: {
        Ends ends;
        for (const auto& child : node.children) ends.merge(From(*child, items, at));
        return ends;
      }
      case Kind::kSequence: {
        Ends ends{at};
        for (const auto& child : node.children) ends = Behind(*child, items, ends);
        return ends;
      }
      case Kind::kRepeat: {
        Ends all;
        Ends ends{at};
        const int most = node.max == Expansion::kUnbounded
                             ? node.min + static_cast<int>(items.size())
                             : node.max;
        for (int turn = 0; turn <= most; ++turn) {
          if (turn >= node.min) all.insert(ends.begin(), ends.end());
          ends = Behind(*node.children[0], items, ends);
        }
        return all;
      }
    }
    return {};
  }
};

TEST(SrgsRandomTest, EveryVerdictAndEveryParseIsRight) {
  int accepted = 0;
  for (unsigned seed = 0; seed < 1000; ++seed) {
    GrammarMaker maker(seed);
    const std::string text = maker.Grammar();
    GrammarContext context;
    context.uri = "random";
    context.alone = true;
    auto made = CompileBytes(text, context);
    ASSERT_TRUE(made) << text << made.error().text;
    GrammarStore store([](const std::string&) -> vm::Result<std::string> {
      return vm::Fail(vm::Errc::kUnavailable, "nothing is fetched");
    });
    auto linked = store.Add(std::move(*made));
    ASSERT_TRUE(linked) << linked.error().text;
    const Rule& root = *(*linked)->RootRule();
    for (int i = 0; i < 4; ++i) {
      const Words words = maker.Input();
      std::string input;
      for (const std::string& word : words) input += (input.empty() ? "" : " ") + word;
      const MatchResult match = Match(root, input);
      ASSERT_FALSE(match.over_limit) << text << "input: " << input;
      ASSERT_EQ(match.parse != nullptr, SpanTable(root, words).Accepts())
          << text << "input: " << input;
      if (!match.parse) continue;
      ++accepted;
      EXPECT_EQ(match.parse->Text(), input) << text;
      EXPECT_TRUE(ParseJudge().IsRight(*match.parse)) << text << "input: " << input << "\n"
                                                      << match.parse->Format();
    }
  }
  EXPECT_GT(accepted, 500);
}

}  // namespace
}  // namespace vxml::srgs
