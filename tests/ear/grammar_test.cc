#include "ear/grammar/grammar.h"

#include <gtest/gtest.h>

#include <ctime>

#include "ear/grammar/grammar_limits.h"

namespace {

using ear::Grammar;

/// The meaning of a text; "-" if it does not fit; the error if the grammar is bad.
std::string Meaning(std::string_view grammar, std::string_view text) {
  auto parsed = ear::ParseGrammar(grammar);
  if (!parsed) return parsed.error().text;
  const auto meaning = parsed->Match(text);
  return meaning ? meaning->Joined() : "-";
}
std::string ErrorOf(std::string_view grammar) {
  auto parsed = ear::ParseGrammar(grammar);
  return parsed ? "" : parsed.error().text;
}

TEST(OwnFormTest, PhrasesHaveOptionsAlternativesAndMeanings) {
  constexpr auto kGrammar = "yes [please] {YES} | (no | nope) {NO} | call * {CALL}";
  EXPECT_EQ(Meaning(kGrammar, "Yes, please!"), "YES");
  EXPECT_EQ(Meaning(kGrammar, "nope"), "NO");
  EXPECT_EQ(Meaning(kGrammar, "call Anna"), "CALL");
  EXPECT_EQ(Meaning(kGrammar, "call Anna Lee"), "CALL");
  EXPECT_EQ(Meaning(kGrammar, "call"), "-");
  EXPECT_EQ(Meaning(kGrammar, ""), "-");
}

TEST(OwnFormTest, RulesRepeatsAndWeightsOverSeveralLines) {
  constexpr auto kGrammar =
      "# fruit\n$count = /3/ one {1} | two {2}\n$fruit = apple {apple} | pear {pear}\n"
      "I want ($count $fruit [and])+ [please]\nroom ($count)<2-3>\n";
  EXPECT_EQ(Meaning(kGrammar, "I want one apple and two pear please"), "1;apple;2;pear");
  EXPECT_EQ(Meaning(kGrammar, "room one"), "-");
  EXPECT_EQ(Meaning(kGrammar, "room one two"), "1;2");
  EXPECT_EQ(Meaning(kGrammar, "room one two one two"), "-");
}

TEST(OwnFormTest, JapaneseNeedsNoBlanks) {
  EXPECT_EQ(Meaning("はい [そう です] {YES} | いいえ {NO}", "はいそうです。"), "YES");
  EXPECT_EQ(Meaning("はい | いいえ {NO}", "いいえ"), "NO");
  EXPECT_EQ(Meaning("はい", "はいはい"), "-");
}

TEST(OwnFormTest, MistakesAreNamedWithTheirLine) {
  EXPECT_EQ(ErrorOf("yes\nno ("), "line 2: found the end, expected a word");
  EXPECT_EQ(ErrorOf("a [b"), "line 1: found the end, expected '|' or ']'");
  EXPECT_EQ(ErrorOf("a )"), "line 1: found ')', expected '|' or the end");
  EXPECT_EQ(ErrorOf("a {b"), "line 1: found the end, expected '}'");
  EXPECT_EQ(ErrorOf("/x/ a"), "line 1: found '/x/ a', expected /NUMBER/ of 0 or more");
  EXPECT_EQ(ErrorOf("a<4-2>"), "line 1: repeats must be from 0 to 1000, the lesser first");
  EXPECT_EQ(ErrorOf("$x = a\n$x = b\n$x"), "line 2: rule 'x' is there twice");
  EXPECT_EQ(ErrorOf("say $nothing"), "line 1: there is no rule 'nothing'");
  EXPECT_EQ(ErrorOf("# nothing\n"), "line 1: there is no phrase");
  EXPECT_EQ(ErrorOf(""), "line 1: there is no phrase");
}

TEST(GrammarTest, LeftRecursionIsNamedAndRightRecursionIsTaken) {
  EXPECT_EQ(ErrorOf("$a = [x] $b\n$b = $a y\n$a"),
            "line 1: rule 'a' begins with itself (a -> b -> a)");
  EXPECT_EQ(Meaning("$a = x [$a]\n$a {T}", "x x x"), "T");
}

std::string Times(int count, const std::string& text) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}
std::string Srgs(const std::string& rule) {
  return "<grammar root='r'><rule id='r'>" + rule + "</rule></grammar>";
}
std::string Doublings(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) {
    text += "$r" + std::to_string(i) + " = $r" + std::to_string(i + 1) + " $r" +
            std::to_string(i + 1) + "\n";
  }
  return text + "$r" + std::to_string(count) + " = yes\n$r0";
}

TEST(GrammarTest, WhatWouldCostTooMuchIsRefusedAtOnceNamingTheRuleAndTheLimit) {
  const std::string written_out = " parts when its repeats and the rules in it are written out";
  std::string every_rule_calls_all = "$r0\n", chain = "$r0\n$r150 = x\n", cycle = "$r0\n";
  for (int i = 0; i < 30; ++i) {
    every_rule_calls_all += "$r" + std::to_string(i) + " = x (y";
    for (int j = 0; j < 30; ++j) every_rule_calls_all += " | $r" + std::to_string(j);
    every_rule_calls_all += ")\n";
  }
  for (int i = 0; i < 150; ++i) {
    chain += "$r" + std::to_string(i) + " = x $r" + std::to_string(i + 1) + "\n";
  }
  for (int i = 0; i < 5000; ++i) {
    cycle += "$r" + std::to_string(i) + " = x $r" + std::to_string((i + 1) % 5000) + "\n";
  }
  const struct {
    std::string grammar, error;
  } cases[] = {
      {"((((yes<1-99>)<1-99>)<1-99>)<1-99>)", "line 1: the phrases: more than 50000" + written_out},
      {"room (((one)<0-1000>)<0-1000>)<0-1000>",
       "line 1: the phrases: more than 50000" + written_out},
      {"yes\n$x = (a b<1000>)<1000>", "line 2: rule 'x': more than 50000" + written_out},
      {Doublings(40), "line 26: rule 'r25': more than 50000" + written_out},
      {every_rule_calls_all, "line 21: rule 'r19': more than 50000" + written_out},
      {"$x = a<1000> {" + std::string(5000, 't') + "}\n($x)<50>",
       "line 1: the phrases: more than 50000" + written_out},
      {"$x = (a {" + std::string(5000, 't') + "})<1000>\n$x",
       "line 1: rule 'x': more than 4194304 bytes when its repeats and the rules in it are written "
       "out"},
      {chain, "line 103: rule 'r100': rules nested deeper than 100"},
      {cycle, "line 102: rule 'r100': rules nested deeper than 100"},
      {std::string(1'000'000, 'a'),
       "line 1: the phrases: a word of 1000000 bytes, expected at most 200"},
      {"no\n$long = " + std::string(201, 'a'),
       "line 2: rule 'long': a word of 201 bytes, expected at most 200"},
      {std::string(60'000, '('), "line 1: the phrases: nested deeper than 64"},
      {"$deep = " + std::string(500, '[') + "a" + std::string(500, ']'),
       "line 1: rule 'deep': nested deeper than 64"},
      {"#JSGF V1.0;\ngrammar g;\npublic <r> = " + std::string(60'000, '(') + ";",
       "line 3: rule 'r': nested deeper than 64"},
      {Srgs(Times(70, "<item>") + Times(70, "</item>")), "line 1: rule 'r': nested deeper than 64"},
      {Srgs("<item repeat='1000'>" + Times(100, "yes ") + "</item>"),
       "line 1: rule 'r': more than 50000" + written_out},
      {Times(200'000, "a | ") + "a", "line 1: the phrases: the grammar has more than 50000 parts"},
      {Times(400'000, "a\n"), "line 50001: the phrases: the grammar has more than 50000 parts"},
      {Srgs(Times(400'000, "a ")), "line 1: rule 'r': the grammar has more than 50000 parts"},
      {std::string(2'000'000, 'a'), "the grammar has 2000000 bytes, expected at most 1048576"},
  };
  for (const auto& [grammar, error] : cases) {
    const std::clock_t begin = std::clock();
    EXPECT_EQ(ErrorOf(grammar), error) << grammar.substr(0, 80);
    // Processor time, since the machine may be busy; a hundredth of a second is usual.
    EXPECT_LT(std::clock() - begin, 2 * CLOCKS_PER_SEC) << grammar.substr(0, 80);
  }
}

TEST(GrammarTest, LargeGrammarsWithinTheLimitsAreTaken) {
  std::string names;
  for (int i = 0; i < 12'000; ++i)
    names += "name" + std::to_string(i) + " {" + std::to_string(i) + "}\n";
  EXPECT_EQ(Meaning(names, "name11999"), "11999");
  EXPECT_EQ(Meaning("room ((one {1})<0-100>)<0-100>", "room one one one"), "1;1;1");
  EXPECT_EQ(Meaning(Doublings(13), Times(8192, "yes ")), "-") << "beyond kMaxMatchBytes";
  EXPECT_EQ(Meaning(Doublings(10), Times(1024, "yes ")), "");
}

TEST(MatchTest, AmbiguousGrammarsEndInTime) {
  const std::string words = Times(600, "a ");
  for (const char* grammar :
       {"((a+)+)+ b", "((a [a])+ (a+))+ b", "$r = a | a $r | a $r $r\n$r b", "* * (* | a+)+ b",
        "(([a] [a] [a] [a] [a] [a] [a] [a])<0-20>)<0-20> b", "$p = a [$p] a | a\n$p b"}) {
    const std::clock_t begin = std::clock();
    EXPECT_EQ(Meaning(grammar, words), "-") << grammar;
    EXPECT_LT(std::clock() - begin, 5 * CLOCKS_PER_SEC) << grammar;
  }
  EXPECT_EQ(Meaning("((a+)+)+ b {T}", words + "b"), "T");
  EXPECT_EQ(Meaning(Times(500, "[a] ") + "b", Times(499, "a ")), "-");
  EXPECT_EQ(Meaning(Times(500, "[a] ") + "b", Times(499, "a ") + "b"), "");
}

TEST(MatchTest, TheFirstAlternativeThatLeadsToTheEndIsTaken) {
  EXPECT_EQ(Meaning("(a {1} | a b {2}) (b {3} | {4} c)", "a b"), "1;3");
  EXPECT_EQ(Meaning("(a {1} | a b {2}) c", "a b c"), "2");
  EXPECT_EQ(Meaning("(a {x})+ (a {y})+", "a a a"), "x;x;y");
  EXPECT_EQ(Meaning("$ab = a {1} | a b {2}\n$ab c {A} | $ab b c {B}", "a b c"), "2;A");
}

TEST(MatchTest, ARuleMayCallItselfInItsMiddle) {
  EXPECT_EQ(Meaning("$p = a [$p] b {T}\n$p", "a a b b"), "T;T");
  EXPECT_EQ(Meaning("$p = a [$p] b {T}\n$p", "a a b"), "-");
}

TEST(MatchTest, AnyWordTakesAWordOrAPartOfAJapaneseOne) {
  EXPECT_EQ(Meaning("* です {D}", "赤門です"), "D");
  EXPECT_EQ(Meaning("* です {D}", "です"), "-");
  EXPECT_EQ(Meaning("* {D}", "赤門です"), "D");
}

TEST(MatchTest, WhatWasNotUnderstoodIsAnyWord) {
  using Words = std::vector<std::string>;
  const auto grammar = ear::ParseGrammar("call * * now {N} | call * {C} | stop {S}");
  ASSERT_TRUE(grammar);
  EXPECT_EQ(grammar->Match(Words{"call", "..."})->Joined(), "C");
  EXPECT_EQ(grammar->Match(Words{"call", "...", "now"})->Joined(), "N");
  EXPECT_EQ(grammar->Match(Words{"call", "my", "...", "now"})->Joined(), "N");
  EXPECT_FALSE(grammar->Match(Words{"...", "stop"}));
  EXPECT_FALSE(grammar->Match("call ..."));
}

TEST(MatchTest, AnyWordsLastAsLongAsTheyMust) {
  EXPECT_EQ(Meaning("call * {C} | tell * that * {T}", "call the whole family at home"), "C");
  EXPECT_EQ(Meaning("call * {C} | tell * that * {T}", "tell my mother that I am late"), "T");
  EXPECT_EQ(Meaning("call * {C}", "call"), "-");
  EXPECT_EQ(Meaning("$GARBAGE yes $GARBAGE {Y}", "yes"), "Y");
  EXPECT_EQ(Meaning("$GARBAGE yes $GARBAGE {Y}", "well I think yes of course"), "Y");
  EXPECT_EQ(Meaning("#JSGF V1.0; grammar g; public <a> = <GARBAGE> yes {Y};", "oh well yes"), "Y");
  EXPECT_EQ(Meaning("<grammar root='a'><rule id='a'><ruleref special='GARBAGE'/>yes<tag>Y</tag>"
                    "</rule></grammar>",
                    "oh well yes"),
            "Y");
}

TEST(WordsTest, CaseAndPunctuationDoNotCount) {
  using Words = std::vector<std::string>;
  EXPECT_EQ(ear::WordsOf("Yes, please!"), (Words{"yes", "please"}));
  EXPECT_EQ(ear::WordsOf(" don't  -  re-do 42 "), (Words{"don't", "re-do", "42"}));
  EXPECT_EQ(ear::WordsOf("はい、A。"), (Words{"はい", "a"}));
  EXPECT_EQ(ear::WordsOf("は\xE3い"), (Words{"は", "い"}));
  EXPECT_TRUE(ear::WordsOf(" ?! \xFF").empty());
}

TEST(OwnFormTest, MalformedPhrasesAreRefusedWithTheirLine) {
  for (const char* bad :
       {"|",      "a |", "| a", "(a",   "[a",   "a]", "()",    "[]",  "{x}",  "a } b",
        "(a | )", "(a]", "a<",  "a<x>", "a<1-", "$",  "$ = a", "\"a", "/1 a", "a<99999999999>"}) {
    EXPECT_EQ(ErrorOf(bad).substr(0, 8), "line 1: ") << bad;
  }
}

constexpr auto kJsgf =
    "#JSGF V1.0 UTF-8 en;\ngrammar cards; // a comment\n/* another\n one */\n"
    "public <cards> = <card> {card}+ | quit {out\\}ish};\n"
    "<card> = <rank> [of] (clubs | hearts) ;\n<rank> = /2/ ace | /1/ two;\n";

TEST(JsgfTest, RulesAndTagsAreRead) {
  EXPECT_EQ(Meaning(kJsgf, "ace of clubs two hearts"), "-");
  EXPECT_EQ(Meaning(kJsgf, "ace of clubs"), "card");
  EXPECT_EQ(Meaning(kJsgf, "quit"), "out}ish");
  EXPECT_EQ(Meaning("#JSGF V1.0; grammar g; public <a> = b* c <NULL>;", "b b c"), "");
}

TEST(JsgfTest, EveryPublicRuleIsActive) {
  const auto grammar =
      "#JSGF V1.0;\ngrammar g;\npublic <a> = yes {A};\n<b> = no {B};\npublic <c> = perhaps <b> "
      "{C};";
  EXPECT_EQ(Meaning(grammar, "yes"), "A");
  EXPECT_EQ(Meaning(grammar, "perhaps no"), "B;C");
  EXPECT_EQ(Meaning(grammar, "no"), "-");
}

TEST(JsgfTest, TagsKeepWhatLooksLikeAComment) {
  EXPECT_EQ(Meaning("#JSGF V1.0; grammar g; public <a> = b {http://x/*y} /* z */ c; // end", "b c"),
            "http://x/*y");
}

TEST(JsgfTest, ARuleMayBeNamedWithItsGrammar) {
  const std::string head = "#JSGF V1.0; grammar com.example.t; <b> = yes {Y}; public <a> = ";
  EXPECT_EQ(Meaning(head + "<t.b>;", "yes"), "Y");
  EXPECT_EQ(Meaning(head + "<com.example.t.b>;", "yes"), "Y");
  EXPECT_EQ(ErrorOf(head + "<u.b>;"), "line 1: there is no rule 'u.b'");
}

TEST(JsgfTest, AWeightOfZeroIsNeverSaid) {
  const auto grammar = "#JSGF V1.0; grammar g; public <a> = /0/ no {N} | /1/ yes {Y};";
  EXPECT_EQ(Meaning(grammar, "no"), "-");
  EXPECT_EQ(Meaning(grammar, "yes"), "Y");
}

TEST(JsgfTest, MistakesAreNamedWithTheirLine) {
  EXPECT_EQ(ErrorOf("#JSGF V1.0;\ngrammar g;\n<a> = b;\n"), "line 4: there is no public rule");
  EXPECT_EQ(ErrorOf("#JSGF V1.0;\ngrammar g;\npublic <a> = b"),
            "line 3: expected ';' at the end of a statement");
  EXPECT_EQ(ErrorOf("#JSGF V1.0;\ngrammar g;\npublic a = b;"),
            "line 3: found 'a = b', expected grammar NAME; or [public] <NAME> = ...;");
  EXPECT_EQ(ErrorOf("#JSGF V1.0;\ngrammar g;\npublic <a> = <b>;"), "line 3: there is no rule 'b'");
  EXPECT_EQ(ErrorOf("#JSGF V1.0;\ngrammar g;\nimport <x.*>;"), "line 3: import is not supported");
}

constexpr auto kSrgs = R"(<?xml version="1.0"?>
<grammar xmlns="http://www.w3.org/2001/06/grammar" root="order" version="1.0" mode="voice">
  <rule id="order" scope="public">
    <example>two pears</example>
    <item repeat="0-1">please</item>
    <one-of><item weight="2">one <tag>1</tag></item><item>two <tag>2</tag></item></one-of>
    <ruleref uri="#fruit"/>
    <item repeat="1-"><token>thanks</token></item>
  </rule>
  <rule id="fruit"><one-of><item>apple</item><item>pears<tag>pear</tag></item></one-of></rule>
</grammar>)";

TEST(SrgsTest, ElementsAreRead) {
  EXPECT_EQ(Meaning(kSrgs, "please two pears thanks thanks"), "2;pear");
  EXPECT_EQ(Meaning(kSrgs, "one apple"), "-");
}

TEST(SrgsTest, MistakesAreNamedWithTheirLine) {
  EXPECT_TRUE(ErrorOf("<grammar><rule id='a'>x</rule>").starts_with("grammar:1:31: "));
  EXPECT_EQ(ErrorOf("<grammar root='b'><rule id='a'>x</rule></grammar>"), "there is no rule 'b'");
  EXPECT_EQ(ErrorOf("<grammar>\n<rule id='a'><ruleref uri='other.xml#x'/></rule></grammar>"),
            "line 2: ruleref to 'other.xml#x', expected uri=\"#RULE\" or special (other files are "
            "not read here)");
  EXPECT_EQ(ErrorOf("<grammar><rule id='a'><item repeat='x'>y</item></rule></grammar>"),
            "line 1: repeat='x', expected N, N-M or N-");
  EXPECT_EQ(ErrorOf("<vxml/>"), "line 1: expected a <grammar> element");
  EXPECT_EQ(ErrorOf("<x:grammar xmlns:x='urn:x'/>"), "line 1: expected a <grammar> element");
}

TEST(SrgsTest, ElementsOfOtherNamespacesSayNothing) {
  EXPECT_EQ(Meaning("<g:grammar xmlns:g='http://www.w3.org/2001/06/grammar' xmlns:x='urn:x'>"
                    "<x:note>n</x:note><g:rule id='a'>yes<x:y>no</x:y><g:one-of><x:z/>"
                    "<g:item>please<g:tag>P</g:tag></g:item></g:one-of></g:rule></g:grammar>",
                    "yes please"),
            "P");
}

}  // namespace
