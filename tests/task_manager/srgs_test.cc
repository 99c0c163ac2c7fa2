// Grammar documents by themselves, judged as SRGS 1.0 asks (sections in the names), and their
// parses.
#include <gtest/gtest.h>

#include "task_manager/grammar/matcher.h"
#include "task_manager/grammar/store.h"

namespace vxml::srgs {
namespace {

GrammarStore NoFetch() {
  return GrammarStore([](const std::string&) -> vm::Result<std::string> {
    return vm::Fail(vm::Errc::kUnavailable, "nothing is fetched");
  });
}

GrammarContext Alone() {
  GrammarContext context;
  context.uri = "g";
  context.alone = true;
  return context;
}

std::string Xml(const std::string& attributes, const std::string& rules) {
  return "<?xml version=\"1.0\"?><grammar xmlns=\"http://www.w3.org/2001/06/grammar\" " +
         attributes + ">" + rules + "</grammar>";
}
std::string InXml(const std::string& rules) {
  return Xml("version=\"1.0\" xml:lang=\"en-US\" root=\"r\"", rules);
}
std::string InAbnf(const std::string& rest) {
  return "#ABNF 1.0 UTF-8;\nlanguage en-US;\nroot $r;\n" + rest;
}

struct Judged {
  const char* name;
  std::string text;
  bool good;
};
class SrgsDocument : public ::testing::TestWithParam<Judged> {};

TEST_P(SrgsDocument, IsJudgedByTheRecommendation) {
  auto made = CompileBytes(GetParam().text, Alone());
  EXPECT_EQ(made.has_value(), GetParam().good) << GetParam().text << "\n"
                                               << (made ? "accepted" : made.error().text);
  if (!made) {
    EXPECT_TRUE(made.error().text.starts_with("g:")) << made.error().text;
  }
}

const std::string kRule = "<rule id=\"r\">a</rule>";

/// With the byte order mark, low byte first.
std::string InUtf16(const std::string& ascii) {
  std::string bytes = "\xff\xfe";
  for (const char c : ascii) bytes += {c, '\0'};
  return bytes;
}

INSTANTIATE_TEST_SUITE_P(
    Xml, SrgsDocument,
    ::testing::Values(
        Judged{"S4_2_Plain", InXml(kRule), true},
        Judged{"S4_2_NoVersion", Xml("xml:lang=\"en\" root=\"r\"", kRule), false},
        Judged{"S4_2_OtherVersion", Xml("version=\"2.0\" xml:lang=\"en\" root=\"r\"", kRule),
               false},
        Judged{"S4_2_NoNamespace",
               "<grammar version=\"1.0\" xml:lang=\"en\" root=\"r\">" + kRule + "</grammar>",
               false},
        Judged{"S4_5_NoLanguage", Xml("version=\"1.0\" root=\"r\"", kRule), false},
        Judged{"S4_5_BadLanguage", Xml("version=\"1.0\" xml:lang=\"en_US!\" root=\"r\"", kRule),
               false},
        Judged{"S4_5_DtmfNeedsNoLanguage",
               Xml("version=\"1.0\" mode=\"dtmf\" root=\"r\"", "<rule id=\"r\">1</rule>"), true},
        Judged{"S4_6_OtherMode", Xml("version=\"1.0\" mode=\"touch\" root=\"r\"", kRule), false},
        Judged{"S4_7_RootUndefined", Xml("version=\"1.0\" xml:lang=\"en\" root=\"x\"", kRule),
               false},
        Judged{"S4_7_NoRootIsAllowed", Xml("version=\"1.0\" xml:lang=\"en\"", kRule), true},
        Judged{"S4_7_RootIsNoReference", Xml("version=\"1.0\" xml:lang=\"en\" root=\"#r\"", kRule),
               false},
        Judged{"S4_TextOutsideRules", InXml("hello" + kRule), false},
        Judged{"S4_TokenOutsideRules", InXml("<token>x</token>" + kRule), false},
        Judged{"S4_9_TagInTheHead", InXml("<tag>var a=1;</tag>" + kRule), true},
        Judged{"S4_9_TagBehindRules", InXml(kRule + "<tag>var a=1;</tag>"), false},
        Judged{"S4_11_Metadata", InXml("<metadata><x xmlns=\"urn:x\">y</x></metadata>" + kRule),
               true},
        Judged{"S4_11_MetaTwice",
               InXml("<meta name=\"a\" http-equiv=\"b\" content=\"c\"/>" + kRule), false},
        Judged{"S4_11_MetaContent", InXml("<meta name=\"a\"/>" + kRule), false},
        Judged{"S4_10_LexiconUri", InXml("<lexicon/>" + kRule), false},
        Judged{"S4_10_LexiconBehindRules", InXml(kRule + "<lexicon uri=\"l\"/>"), false},
        Judged{"SF_ForeignElement", InXml("<x:y xmlns:x=\"urn:x\">z</x:y>" + kRule), true},
        Judged{"SF_ForeignInRule", InXml("<rule id=\"r\">a <y xmlns=\"urn:x\"/></rule>"), true},
        Judged{"S2_UnknownElement", InXml("<rule id=\"r\"><choice>a</choice></rule>"), false},
        Judged{"S2_1_TokenWithElement", InXml("<rule id=\"r\"><token>a<tag>b</tag></token></rule>"),
               false},
        Judged{"S2_1_TokenEmpty", InXml("<rule id=\"r\"><token/></rule>"), false},
        Judged{"S2_1_QuoteOpen", InXml("<rule id=\"r\">\"a b</rule>"), false},
        Judged{"S2_2_RulerefEmpty", InXml("<rule id=\"r\"><ruleref/></rule>"), false},
        Judged{"S2_2_RulerefBoth",
               InXml("<rule id=\"r\"><ruleref uri=\"#r\" special=\"NULL\"/></rule>"), false},
        Judged{"S2_2_RulerefWithContent",
               InXml("<rule id=\"r\"><ruleref special=\"NULL\">a</ruleref></rule>"), false},
        Judged{"S2_2_3_SpecialUnknown", InXml("<rule id=\"r\"><ruleref special=\"null\"/></rule>"),
               false},
        Judged{"S2_3_EmptyItem", InXml("<rule id=\"r\"><item/></rule>"), true},
        Judged{"S2_4_OneOfEmpty", InXml("<rule id=\"r\"><one-of/></rule>"), false},
        Judged{"S2_4_OneOfText", InXml("<rule id=\"r\"><one-of>a<item>b</item></one-of></rule>"),
               false},
        Judged{"S2_4_OneOfToken", InXml("<rule id=\"r\"><one-of><token>b</token></one-of></rule>"),
               false},
        Judged{"S2_4_1_WeightZero",
               InXml("<rule id=\"r\"><one-of><item weight=\"0\">b</item></one-of></rule>"), false},
        Judged{"S2_4_1_WeightOutsideOneOf",
               InXml("<rule id=\"r\"><item weight=\"x\">b</item></rule>"), false},
        Judged{"S2_5_RepeatBackwards", InXml("<rule id=\"r\"><item repeat=\"3-2\">b</item></rule>"),
               false},
        Judged{"S2_5_RepeatNegative", InXml("<rule id=\"r\"><item repeat=\"-2\">b</item></rule>"),
               false},
        Judged{"S2_5_RepeatBlankInside",
               InXml("<rule id=\"r\"><item repeat=\"1 - 2\">b</item></rule>"), false},
        Judged{"S2_5_RepeatStar", InXml("<rule id=\"r\"><item repeat=\"*\">b</item></rule>"),
               false},
        Judged{"S2_5_RepeatZero", InXml("<rule id=\"r\">a<item repeat=\"0\">b</item></rule>"),
               true},
        Judged{"S2_5_1_Probability",
               InXml("<rule id=\"r\"><item repeat=\"0-\" repeat-prob=\"1.1\">b</item></rule>"),
               false},
        Judged{"S2_6_TagWithElement", InXml("<rule id=\"r\">a<tag><item/></tag></rule>"), false},
        Judged{"S2_7_TokenLanguage",
               InXml("<rule id=\"r\"><token xml:lang=\"fr-CA\">oui</token></rule>"), true},
        Judged{"S3_1_EmptyRule", InXml("<rule id=\"r\"><example>x</example></rule>"), false},
        Judged{"S3_1_RuleTwice", InXml(kRule + kRule), false},
        Judged{"S3_1_NameWithDot", InXml(kRule + "<rule id=\"a.b\">c</rule>"), false},
        Judged{"S3_1_NameWithColon", InXml(kRule + "<rule id=\"a:b\">c</rule>"), false},
        Judged{"S3_1_SpecialName", InXml(kRule + "<rule id=\"GARBAGE\">c</rule>"), false},
        Judged{"S3_1_NoId", InXml(kRule + "<rule>c</rule>"), false},
        Judged{"S3_2_Scope", InXml(kRule + "<rule id=\"s\" scope=\"protected\">c</rule>"), false},
        Judged{"S3_3_ExampleWithElement",
               InXml("<rule id=\"r\"><example><item/></example>a</rule>"), false}),
    [](const auto& instance) { return std::string(instance.param.name); });

INSTANTIATE_TEST_SUITE_P(
    Abnf, SrgsDocument,
    ::testing::Values(
        Judged{"S4_1_Plain", InAbnf("$r = a;"), true},
        Judged{"S4_1_WithoutCharset", "#ABNF 1.0;\nlanguage en;\n$r = a;", true},
        Judged{"S4_1_ByteOrderMark", "\xef\xbb\xbf" + InAbnf("$r = a;"), true},
        Judged{"S4_1_BlankInFront", "\n" + InAbnf("$r = a;"), false},
        Judged{"S4_1_TwoBlanks", "#ABNF  1.0;\nlanguage en;\n$r = a;", false},
        Judged{"S4_1_NoVersion", "#ABNF;\nlanguage en;\n$r = a;", false},
        Judged{"S4_1_OtherVersion", "#ABNF 1.1;\nlanguage en;\n$r = a;", false},
        Judged{"S4_1_TwoCharsets", "#ABNF 1.0 UTF-8 UTF-8;\nlanguage en;\n$r = a;", false},
        Judged{"S4_1_NoSemicolon", "#ABNF 1.0\nlanguage en", false},
        Judged{"S4_1_NoNewLine", "#ABNF 1.0;/* */\nlanguage en;\n$r = a;", false},
        Judged{"S4_1_Utf16", InUtf16("#ABNF 1.0 UTF-16;\nlanguage en;\n$r = a;"), true},
        Judged{"S4_1_Utf16Xml", InUtf16(InXml(kRule)), true},
        Judged{"S4_1_UnknownCharset", "#ABNF 1.0 KLINGON;\nlanguage en;\n$r = a;", false},
        Judged{"S4_5_NoLanguage", "#ABNF 1.0;\n$r = a;", false},
        Judged{"S4_5_DtmfNeedsNoLanguage", "#ABNF 1.0;\nmode dtmf;\n$r = 1 \"*\";", true},
        Judged{"S4_ModeTwice", "#ABNF 1.0;\nmode voice;\nmode voice;\nlanguage en;\n$r = a;",
               false},
        Judged{"S4_AnyOrder",
               "#ABNF 1.0;\nroot $r;\ntag-format <semantics/1.0>;\nmode voice;\nlanguage en;\n"
               "base <http://a/>;\nlexicon <l>~<m/n>;\nmeta \"a\" is 'b';\n{x=1};\n$r = a;",
               true},
        Judged{"S4_TagFormatWithoutBrackets",
               "#ABNF 1.0;\nlanguage en;\ntag-format semantics;\n$r = a;", false},
        Judged{"S4_TagBehindRules", InAbnf("$r = a; {x};"), false},
        Judged{"S4_DeclarationBehindRules", "#ABNF 1.0;\n$r = a;\nlanguage en;", false},
        Judged{"S2_1_ReservedSign", InAbnf("$r = a * b;"), false},
        Judged{"S2_1_ReservedSignQuoted", InAbnf("$r = a \"*\" b;"), true},
        Judged{"S2_3_EmptyGroup", InAbnf("$r = ();"), true},
        Judged{"S2_3_EmptyBrackets", InAbnf("$r = [];"), false},
        Judged{"S2_4_EmptyAlternative", InAbnf("$r = a | ;"), false},
        Judged{"S2_4_1_Weights", InAbnf("$r = /1/ a | /2./ b | /.5/ c | /1.5/ d;"), true},
        Judged{"S2_4_1_WeightNegative", InAbnf("$r = /-1/ a | b;"), false},
        Judged{"S2_5_RepeatWithProbability", InAbnf("$r = a<0-2 /0.5/>;"), true},
        Judged{"S2_5_RepeatBackwards", InAbnf("$r = a<2-1>;"), false},
        Judged{"S2_5_RepeatTwice", InAbnf("$r = (a)<2><3>;"), false},
        Judged{"S2_5_RepeatWithoutNumber", InAbnf("$r = a<->;"), false},
        Judged{"S2_6_LongTag", InAbnf("$r = a {!{ if (x) { y } }!};"), true},
        Judged{"S2_6_TagOpen", InAbnf("$r = a {b;"), false},
        Judged{"S2_7_Language", InAbnf("$r = \"oui\"!fr-CA | (a b)!en-GB<2>;"), true},
        Judged{"S2_7_LanguageBehindBlank", InAbnf("$r = a !en-US (oui | bien sur) !fr <2>;"), true},
        Judged{"S2_7_LanguageOfReference", InAbnf("$r = $b!fr; $b = a;"), false},
        Judged{"S2_7_LanguageOfTag", InAbnf("$r = a {b}!fr;"), false},
        Judged{"S2_7_LanguageMissing", InAbnf("$r = a!;"), false},
        Judged{"S3_1_EmptyRule", InAbnf("$r = ;"), false},
        Judged{"S3_1_NameWithHyphen", InAbnf("$r = a; $a-b = c;"), false},
        Judged{"S3_1_SpecialName", InAbnf("$r = a; $NULL = c;"), false},
        Judged{"S3_1_RuleTwice", InAbnf("$r = a; $r = b;"), false},
        Judged{"S3_1_NoSemicolon", InAbnf("$r = a"), false},
        Judged{"S3_2_Scopes", InAbnf("public $r = $b; private $b = a;"), true},
        Judged{"S3_2_UnknownScope", InAbnf("protected $r = a;"), false},
        Judged{"CommentOpen", InAbnf("$r = a; /* b"), false}),
    [](const auto& instance) { return std::string(instance.param.name); });

struct Parsed {
  const char* name;
  std::string grammar;
  const char* input;
  const char* parse;  ///< "" = rejected
};
class SrgsParse : public ::testing::TestWithParam<Parsed> {};

TEST_P(SrgsParse, IsTheOneTheGrammarGives) {
  auto made = CompileBytes(GetParam().grammar, Alone());
  ASSERT_TRUE(made) << made.error().text;
  auto store = NoFetch();
  auto linked = store.Add(std::move(*made));
  ASSERT_TRUE(linked) << linked.error().text;
  ASSERT_NE((*linked)->RootRule(), nullptr);
  const auto match = Match(*(*linked)->RootRule(), GetParam().input);
  EXPECT_EQ(match.parse ? match.parse->Format() : "", GetParam().parse);
}

INSTANTIATE_TEST_SUITE_P(
    Trees, SrgsParse,
    ::testing::Values(
        Parsed{"Tokens", InAbnf("$r = a b \"c d\";"), "a b c d", "$r[\"a\", \"b\", \"c d\"]"},
        Parsed{"TokensOfXml", InXml("<rule id=\"r\">a <token> c\n d </token></rule>"), "a c d",
               "$r[\"a\", \"c d\"]"},
        Parsed{"TagsAroundAndBetween", InAbnf("$r = {1} a {2} {3} b {4};"), "a b",
               "$r[{1}, \"a\", {2}, {3}, \"b\", {4}]"},
        Parsed{"Reference", InAbnf("$r = a $b; $b = c {x};"), "a c", "$r[\"a\", $b[\"c\", {x}]]"},
        Parsed{"NullIsNothing", InAbnf("$r = a $NULL b;"), "a b", "$r[\"a\", \"b\"]"},
        Parsed{"VoidNeverMatches", InAbnf("$r = a [$VOID] | b $VOID;"), "b", ""},
        Parsed{"VoidAsAnAlternative", InAbnf("$r = $VOID | b;"), "b", "$r[\"b\"]"},
        Parsed{"VoidNoTimes", InAbnf("$r = $VOID<0> b;"), "b", "$r[\"b\"]"},
        Parsed{"Garbage", InAbnf("$r = $GARBAGE b;"), "x y b", "$r[$GARBAGE[\"x y\"], \"b\"]"},
        Parsed{"RepeatBindsTighterThanSequence", InAbnf("$r = a b<2>;"), "a b b",
               "$r[\"a\", \"b\", \"b\"]"},
        Parsed{"SequenceBindsTighterThanAlternatives", InAbnf("$r = a b | c;"), "a c", ""},
        Parsed{"WeightsChoose", InAbnf("$r = /1/ $x | /5/ $y; $x = a; $y = a;"), "a",
               "$r[$y[\"a\"]]"},
        Parsed{"FirstAlternativeOfEqualWeight", InAbnf("$r = $x | $y; $x = a; $y = a;"), "a",
               "$r[$x[\"a\"]]"},
        Parsed{"RepeatedGroupWithTags", InAbnf("$r = (a {t})<1-3>;"), "a a",
               "$r[\"a\", {t}, \"a\", {t}]"},
        Parsed{"LeftRecursion", InAbnf("$r = $r a | a;"), "a a a",
               "$r[$r[$r[\"a\"], \"a\"], \"a\"]"},
        Parsed{"RightRecursion", InAbnf("$r = a $r | a;"), "a a a",
               "$r[\"a\", $r[\"a\", $r[\"a\"]]]"},
        Parsed{"TwoSidedRecursion", InAbnf("$r = $r $r | a;"), "a a a",
               "$r[$r[$r[\"a\"], $r[\"a\"]], $r[\"a\"]]"},
        Parsed{"CyclicRecursion", InAbnf("$r = $r | a;"), "a", "$r[\"a\"]"},
        Parsed{"CycleThroughEmptyParts", InAbnf("$r = $s $s | a; $s = [$r];"), "a", "$r[\"a\"]"},
        Parsed{"RepeatedTagOnce", InAbnf("$r = a {t}<2-3> ({u} {v})<4>;"), "a",
               "$r[\"a\", {t}, {u}, {v}]"},
        Parsed{"CaseOfGreek", InAbnf("$r = ΤΈΛΟΣ;"), "τέλος", "$r[\"ΤΈΛΟΣ\"]"},
        Parsed{"CaseOfCyrillic", InAbnf("$r = Ѐ Ѡ Ӂ;"), "ѐ ѡ ӂ", "$r[\"Ѐ\", \"Ѡ\", \"Ӂ\"]"},
        Parsed{"CaseOfLatinExtended", InAbnf("$r = Ĺ Ň Ÿ Ź;"), "ĺ ň ÿ ź",
               "$r[\"Ĺ\", \"Ň\", \"Ÿ\", \"Ź\"]"},
        Parsed{"CaseOfVietnamese", InAbnf("$r = \"Ơ Ế\";"), "ơ e\u0302\u0301", "$r[\"Ơ Ế\"]"},
        Parsed{"FullCaseFolding", InAbnf("$r = Straße;"), "STRASSE", "$r[\"Straße\"]"},
        Parsed{"CaseDoesNotCount", InAbnf("$r = New York;"), "new YORK", "$r[\"New\", \"York\"]"},
        Parsed{"Keys", "#ABNF 1.0;\nmode dtmf;\nroot $r;\n$r = 1 pound \"*\";", "1 # *",
               "$r[\"1\", \"#\", \"*\"]"},
        Parsed{"NamedKeys", "#ABNF 1.0;\nmode dtmf;\nroot $r;\n$r = 1 pound \"*\";", "1 pound star",
               "$r[\"1\", \"#\", \"*\"]"},
        Parsed{"TheWholeInput", InAbnf("$r = a;"), "a b", ""}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST(SrgsAloneTest, AGrammarWithoutRootHasNoneEvenIfItHasOneRule) {
  auto made = CompileBytes(Xml("version=\"1.0\" xml:lang=\"en\"", kRule), Alone());
  ASSERT_TRUE(made);
  EXPECT_EQ((*made)->RootRule(), nullptr);
}

TEST(SrgsAloneTest, TheTypeOfAReferenceCounts) {
  GrammarStore store(
      [](const std::string&) -> vm::Result<std::string> { return InAbnf("public $r = b;"); });
  const auto link = [&store](const std::string& type) {
    auto made = CompileBytes(InAbnf("$r = a $<other.gram>" + type + ";"), Alone());
    return made && store.Add(std::move(*made));
  };
  EXPECT_TRUE(link(""));
  EXPECT_TRUE(link("~<application/srgs>"));
  EXPECT_FALSE(link("~<application/srgs+xml>"));
  EXPECT_FALSE(link("~<audio/basic>"));
}

TEST(SrgsAloneTest, ErrorsOfReferencesNameTheirPlace) {
  auto made = CompileBytes(InAbnf("$r = a\n  b $nowhere;"), Alone());
  ASSERT_TRUE(made);
  auto store = NoFetch();
  const auto linked = store.Add(std::move(*made));
  ASSERT_FALSE(linked);
  EXPECT_TRUE(linked.error().text.starts_with("g:5:5: ")) << linked.error().text;
}

TEST(SrgsAloneTest, AGrammarWithoutRootLoads) {
  GrammarStore store([](const std::string&) -> vm::Result<std::string> {
    return std::string("#ABNF 1.0;\nlanguage en;\n$r = a;");
  });
  EXPECT_TRUE(store.Load("http://host/g", Alone(), nullptr));
}

TEST(SrgsLimitsTest, AmbiguousAndCountedRepeatsOfHundredsOfWordsAreMatched) {
  std::string input;
  for (int i = 0; i < 320; ++i) input += "x ";
  for (const char* rule :
       {"$r = $r $r | x;", "$r = ((x<0->)<0->)<0->;", "$r = ((x<0-100>)<3-100>)<0-200>;",
        "$r = ([x] $s)<5->; $s = [x] [$s];"}) {
    auto made = CompileBytes(InAbnf(rule), Alone());
    ASSERT_TRUE(made);
    auto store = NoFetch();
    auto linked = store.Add(std::move(*made));
    ASSERT_TRUE(linked);
    EXPECT_NE(Match(*(*linked)->RootRule(), input).parse, nullptr) << rule;
  }
}

TEST(SrgsAloneTest, GrammarsReferredToAreJudgedAsStrictly) {
  GrammarStore store([](const std::string&) -> vm::Result<std::string> {
    return std::string("<grammar root=\"r\"><rule id=\"r\" scope=\"public\">b</rule></grammar>");
  });
  auto made = CompileBytes(InAbnf("$r = a $<other.grxml>;"), Alone());
  ASSERT_TRUE(made);
  EXPECT_FALSE(store.Add(std::move(*made)));
}

}  // namespace
}  // namespace vxml::srgs
