#include "srm/grammar/grammar.h"

#include <gtest/gtest.h>

#include "srm/grammar/jsgf_output.h"

namespace {

using srm::Grammar;

/// The meaning of a text; "-" if it does not fit; the error if the grammar is bad.
std::string Meaning(std::string_view grammar, std::string_view text) {
  auto parsed = srm::ParseGrammar(grammar);
  if (!parsed) return parsed.error().text;
  const auto meaning = parsed->Match(text);
  return meaning ? meaning->Joined() : "-";
}
std::string ErrorOf(std::string_view grammar) {
  auto parsed = srm::ParseGrammar(grammar);
  return parsed ? "" : parsed.error().text;
}

TEST(OwnFormTest, PhrasesHaveOptionsAlternativesAndMeanings) {
  constexpr auto kGrammar = "yes [please] {YES} | (no | nope) {NO} | call * {CALL}";
  EXPECT_EQ(Meaning(kGrammar, "Yes, please!"), "YES");
  EXPECT_EQ(Meaning(kGrammar, "nope"), "NO");
  EXPECT_EQ(Meaning(kGrammar, "call Anna"), "CALL");
  EXPECT_EQ(Meaning(kGrammar, "call Anna Lee"), "-");
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
  EXPECT_EQ(ErrorOf("/x/ a"), "line 1: found '/x/ a', expected /NUMBER/ above 0");
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

TEST(GrammarTest, HugeNestingAndSizeAreRefused) {
  EXPECT_EQ(ErrorOf(std::string(500, '(') + "a" + std::string(500, ')')), "nested too deep");
  EXPECT_NE(ErrorOf(std::string(2'000'000, 'a')).find("expected at most"), std::string::npos);
}

TEST(GrammarTest, AnAmbiguousGrammarEndsInTime) {
  EXPECT_EQ(Meaning("((a+)+)+ b", std::string("a a a a a a a a a a a a a a a a a a a a a a c")),
            "-");
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
  EXPECT_EQ(ErrorOf("<grammar><rule id='a'>x</rule>"),
            "line 1: the XML is broken (XML_ERROR_PARSING)");
  EXPECT_EQ(ErrorOf("<grammar root='b'><rule id='a'>x</rule></grammar>"), "there is no rule 'b'");
  EXPECT_EQ(ErrorOf("<grammar>\n<rule id='a'><ruleref uri='other.xml#x'/></rule></grammar>"),
            "line 2: ruleref to 'other.xml#x', expected uri=\"#RULE\" or special (other files are "
            "not read here)");
  EXPECT_EQ(ErrorOf("<grammar><rule id='a'><item repeat='x'>y</item></rule></grammar>"),
            "line 1: repeat='x', expected N, N-M or N-");
  EXPECT_EQ(ErrorOf("<vxml/>"), "line 1: expected a <grammar> element");
  EXPECT_EQ(ErrorOf("<!DOCTYPE g [<!ENTITY a 'b'>]><grammar/>"),
            "a grammar with ENTITY declarations is not read");
}

TEST(JsgfOutputTest, SeveralGrammarsAreAlternativesOfOne) {
  auto yes = srm::ParseGrammar("yes [please] {Y}");
  auto no = srm::ParseGrammar("no<1-2>");
  EXPECT_EQ(srm::ToJsgf({&*yes, &*no}),
            "#JSGF V1.0;\ngrammar all;\npublic <all> = <g0_0> | <g1_0> ;\n"
            "<g0_0> = ( /1/ ( yes ( [ ( please ) ] ) ) ) ;\n"
            "<g1_0> = ( /1/ ( ( no [ no ] ) ) ) ;\n");
}

}  // namespace
