#include <gtest/gtest.h>

#include <chrono>
#include <ctime>

#include "task_manager/grammar/compiler.h"
#include "task_manager/grammar/matcher.h"
#include "task_manager/grammar/store.h"
#include "task_manager/script/engine.h"
#include "tests/task_manager/case_file.h"
#include "vm_protocol/xml/parser.h"

namespace vxml_test {
namespace {

std::string Times(const std::string& text, std::size_t count) {
  std::string all;
  all.reserve(text.size() * count);
  for (std::size_t i = 0; i < count; ++i) all += text;
  return all;
}

Outcome RunDoc(const std::string& body, const std::vector<std::string>& expected,
               const std::string& script = "",
               const std::map<std::string, std::string>& more = {}) {
  Case made;
  made.name = "hostile";
  made.files = more;
  made.files["main.vxml"] = body;
  made.expected = expected;
  made.script = script;
  return RunCase(made);
}

const std::vector<std::string> kRefused{"reason: error.badfetch"};

TEST(HostileXmlTest, AnEntityBombIsRefused) {
  std::string dtd = "<?xml version=\"1.0\"?><!DOCTYPE vxml [<!ENTITY a \"lol\">";
  for (char c = 'b'; c <= 'k'; ++c) {
    dtd += std::string("<!ENTITY ") + c + " \"" + Times(std::string("&") + char(c - 1) + ";", 10) +
           "\">";
  }
  const auto outcome =
      RunDoc(dtd + "]><vxml version=\"2.1\"><form><block>&k;</block></form></vxml>", kRefused);
  EXPECT_TRUE(outcome.pass) << outcome.why;
}

TEST(HostileXmlTest, AnExternalEntityIsNotRead) {
  const auto outcome = RunDoc(
      "<?xml version=\"1.0\"?><!DOCTYPE vxml [<!ENTITY e SYSTEM \"file:///etc/passwd\">]>"
      "<vxml version=\"2.1\"><form><block>[&e;]</block></form></vxml>",
      {"prompts: []"});
  EXPECT_TRUE(outcome.pass) << outcome.why;
}

TEST(HostileXmlTest, AnAttributeOverAMegabyteIsRefused) {
  const auto outcome =
      RunDoc("<form id=\"" + std::string((1 << 20) + 1, 'x') + "\"><block/></form>", kRefused);
  EXPECT_TRUE(outcome.pass) << outcome.why;
}

TEST(HostileXmlTest, AHundredThousandLevelsAreRefused) {
  const auto outcome =
      RunDoc("<form><block>" + Times("<if cond=\"true\">", 100'000) + "</block></form>", kRefused);
  EXPECT_TRUE(outcome.pass) << outcome.why;
}

TEST(HostileXmlTest, AVeryLargeDocumentIsRefused) {
  const auto outcome = RunDoc("<form><block>" + Times("x ", 5 << 20) + "</block></form>", kRefused);
  EXPECT_TRUE(outcome.pass) << outcome.why;
}

TEST(HostileXmlTest, BadEncodingsAreRefusedWithAPlace) {
  auto parsed = vm::xml::Parse("<?xml version=\"1.0\" encoding=\"euc-jp\"?><a>\xff\xff</a>", "d");
  ASSERT_FALSE(parsed);
  EXPECT_NE(parsed.error().text.find("euc-jp"), std::string::npos);
  parsed = vm::xml::Parse("<?xml version=\"1.0\" encoding=\"klingon\"?><a/>", "d");
  ASSERT_FALSE(parsed);
  EXPECT_NE(parsed.error().text.find("klingon"), std::string::npos);
}

TEST(HostileXmlTest, EucJpAndShiftJisAreRead) {
  auto parsed = vm::xml::Parse("<?xml version=\"1.0\" encoding=\"euc-jp\"?><a>\xa4\xa2</a>", "d");
  ASSERT_TRUE(parsed) << parsed.error().text;
  EXPECT_EQ(parsed->root->Text(), "\u3042");
  parsed = vm::xml::Parse("<?xml version=\"1.0\" encoding=\"Shift_JIS\"?><a>\x82\xa0</a>", "d");
  ASSERT_TRUE(parsed) << parsed.error().text;
  EXPECT_EQ(parsed->root->Text(), "\u3042");
}

TEST(HostileXmlTest, ShiftJisIsWhatPcsWriteUnderEachOfItsNames) {
  for (const std::string name : {"Shift_JIS", "shift-jis", "SJIS", "CP932"}) {
    auto parsed =
        vm::xml::Parse("<?xml version=\"1.0\" encoding=\"" + name + "\"?><a>\x87\x40\\~</a>", "d");
    ASSERT_TRUE(parsed) << parsed.error().text;
    EXPECT_EQ(parsed->root->Text(), "\u2460\\~") << name;  // a sign of NEC, and no yen
  }
}

struct EndlessScript {
  const char* name;
  const char* text;
};
class HostileScript : public ::testing::TestWithParam<EndlessScript> {};

TEST_P(HostileScript, EndsInAnErrorAndTheEngineGoesOn) {
  vxml::script::Limits limits;
  limits.time = std::chrono::milliseconds(100);
  limits.heap_bytes = std::size_t{8} << 20;
  vxml::script::Engine engine(limits);
  const vxml::script::Chain chain{engine.NewScope()};
  EXPECT_FALSE(engine.Run(chain, GetParam().text)) << GetParam().text;
  auto after = engine.Evaluate(chain, "6 * 7");
  ASSERT_TRUE(after) << after.error().text;
  EXPECT_EQ(engine.ToString(*after), "42");
}

INSTANTIATE_TEST_SUITE_P(
    Endless, HostileScript,
    ::testing::Values(EndlessScript{"While", "while(true){}"},
                      EndlessScript{"WhileEmpty", "while(1);"}, EndlessScript{"For", "for(;;){}"},
                      EndlessScript{"ForTest", "for(var i=0;i>=0;i++);"},
                      EndlessScript{"DoWhile", "do{}while(1)"},
                      EndlessScript{"Recursion", "function f(){return f()+1} f()"},
                      EndlessScript{"Doubling", "function f(n){if(n>0){f(n-1);f(n-1)}} f(60)"},
                      EndlessScript{"Caught", "while(true){try{while(true){}}catch(e){}}"},
                      EndlessScript{"Eval", "eval('while(true){}')"},
                      EndlessScript{"FunctionOfText",
                                    "(function(){}).constructor('while(true){}')()"},
                      EndlessScript{"Memory", "var s='x'; while(true) s+=s;"},
                      EndlessScript{"Array", "var a=[]; while(true) a.push([1,2,3,4,5,6,7,8]);"},
                      EndlessScript{"LabelledLoop", "a: while(true){ continue a; }"},
                      EndlessScript{"Brackets", "((((("}, EndlessScript{"OpenString", "var a='"},
                      EndlessScript{"Escape", "}});while(1){}({"}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST(HostileDialogTest, AnEndlessScriptIsErrorNoresource) {
  const auto outcome = RunDoc(
      "<form><catch event=\"error.noresource\"><pass/></catch><block><script>while(true){}"
      "</script></block></form>",
      {"exit: pass"});
  EXPECT_TRUE(outcome.pass) << outcome.why;
}

TEST(HostileDialogTest, AnEndlessGotoIsErrorNoresource) {
  const auto outcome = RunDoc("<form id=\"a\"><block><goto next=\"#a\"/></block></form>",
                              {"reason: error.noresource"});
  EXPECT_TRUE(outcome.pass) << outcome.why;
}

TEST(HostileDialogTest, AnEndlessClearIsErrorNoresource) {
  const auto outcome = RunDoc("<form><block name=\"b\"><clear namelist=\"b\"/></block></form>",
                              {"reason: error.noresource"});
  EXPECT_TRUE(outcome.pass) << outcome.why;
}

TEST(HostileDialogTest, AHandlerCanEndAnEndlessLoop) {
  const auto outcome = RunDoc(
      "<catch event=\"error.noresource\"><pass/></catch><form id=\"a\"><block><goto next=\"#a\"/>"
      "</block></form>",
      {"exit: pass"});
  EXPECT_TRUE(outcome.pass) << outcome.why;
}

TEST(HostileDialogTest, ScriptsAndItemsTogetherAreBounded) {
  const auto outcome = RunDoc(
      "<form><block name=\"b\"><script>for (let i = 0; i &lt; 200000; i++);</script>"
      "<clear namelist=\"b\"/></block></form>",
      {"reason: error.noresource"});
  EXPECT_TRUE(outcome.pass) << outcome.why;
}

TEST(HostileDialogTest, ManyItemsAreGoneThroughOnce) {
  // Each choice began at the first item: 10,000 blocks took more than a minute.
  const auto named = [](const std::string& content) {
    std::string blocks;
    for (int i = 0; i < 10'000; ++i) {
      blocks += "<block name=\"b" + std::to_string(i) + "\">" + content + "</block>";
    }
    return blocks;
  };
  for (const std::string& blocks :
       {Times("<block/>", 10'000), named(""), named("<script>1</script>"),
        Times("<block><var name=\"x\" expr=\"1\"/></block>", 10'000)}) {
    const auto outcome =
        RunDoc("<form>" + blocks + "<block><pass/></block></form>", {"exit: pass"});
    EXPECT_TRUE(outcome.pass) << outcome.why;
  }
}

TEST(HostileDialogTest, AConditionOfAnEarlierItemIsLookedAtAgain) {
  const auto outcome = RunDoc(
      "<var name=\"n\" expr=\"0\"/><form><block cond=\"n++ == 2\"><pass/></block><block/><block/>"
      "<block/><block/></form>",
      {"exit: pass"});
  EXPECT_TRUE(outcome.pass) << outcome.why;
}

TEST(HostileDialogTest, AnItemThatAScriptClearsIsVisitedAgain) {
  for (const char* clear : {"<script>a = undefined</script>", "<script>dialog.a = void 0</script>",
                            "<assign name=\"a\" expr=\"undefined\"/>", "<clear namelist=\"a\"/>",
                            "<script>with (dialog) a = undefined</script>"}) {
    const auto outcome = RunDoc(
        "<var name=\"n\" expr=\"0\"/><form><block name=\"a\"><assign "
        "name=\"n\" expr=\"n + 1\"/><if cond=\"n == 2\"><pass/></if>"
        "</block><block>" +
            std::string(clear) + "</block></form>",
        {"exit: pass"});
    EXPECT_TRUE(outcome.pass) << clear << outcome.why;
  }
}

TEST(HostileDialogTest, ManyFormsCostATurnNothing) {
  std::string forms;
  for (int i = 0; i < 10'000; ++i) {
    forms += "<form id=\"f" + std::to_string(i) + "\"><block><goto next=\"#g" +
             std::to_string(i + 1) + "\"/></block></form><form id=\"g" + std::to_string(i) +
             "\"><block><goto next=\"#f" + std::to_string(i) + "\"/></block></form>";
  }
  const auto outcome =
      RunDoc(forms + "<form id=\"g10000\"><block><pass/></block></form>", {"exit: pass"});
  EXPECT_TRUE(outcome.pass) << outcome.why;
}

TEST(HostileDialogTest, WhatALoopLogsAndQueuesIsBounded) {
  const std::string text = "<var name=\"s\" expr=\"new Array(30000).join('x')\"/>";
  for (const char* element :
       {"<log expr=\"s\"/>", "<prompt><value expr=\"s\"/></prompt>", "<native expr=\"s\"/>"}) {
    const auto outcome =
        RunDoc(text +
                   "<catch event=\"error.noresource\"><exit expr=\"'bounded'\"/></catch>"
                   "<form id=\"a\"><block>" +
                   element + "<goto next=\"#a\"/></block></form>",
               {"exit: bounded"});
    EXPECT_TRUE(outcome.pass) << element << outcome.why;
    EXPECT_LT(outcome.transcript.size(), std::size_t{80} << 20) << element;
  }
}

TEST(HostileDialogTest, ManyPromptsAreQueuedInTimeThatGrowsWithTheirNumber) {
  // Looking for properties went through all of them for each of them: 35 s.
  const double before = static_cast<double>(std::clock());
  const auto outcome =
      RunDoc("<form><property name=\"bargein\" value=\"false\"/>" +
                 Times("<block><prompt>a</prompt></block>", 10) + "<block>" +
                 Times("<prompt>a</prompt>", 40'000) + "</block><block><pass/></block></form>",
             {"exit: pass"});
  EXPECT_TRUE(outcome.pass) << outcome.why << outcome.transcript.substr(0, 500);
  EXPECT_LT((static_cast<double>(std::clock()) - before) / CLOCKS_PER_SEC, 15);
}

TEST(HostileDialogTest, SlowExpressionsTogetherAreBounded) {
  const std::string slow = "(() => { for (let i = 0; i &lt; 2e6; i++); return 'a' })()";
  std::string names;
  for (int i = 0; i < 200; ++i)
    names += "<param name=\"p" + std::to_string(i) + "\" expr=\"" + slow + "\"/>";
  const double before = static_cast<double>(std::clock());
  const auto outcome = RunDoc("<form><subdialog name=\"s\" src=\"#a\">" + names +
                                  "</subdialog></form><form id=\"a\"><block/></form>",
                              {"reason: error.noresource"});
  EXPECT_TRUE(outcome.pass) << outcome.why;
  EXPECT_LT((static_cast<double>(std::clock()) - before) / CLOCKS_PER_SEC, 30);
}

TEST(HostileDialogTest, TransfersWithoutEndOfTheScriptEnd) {
  const auto outcome = RunDoc(
      "<form><transfer name=\"t\" dest=\"tel:+1\" type=\"consultation\"><filled><clear/></filled>"
      "</transfer></form>",
      {"reason: hangup"});
  EXPECT_TRUE(outcome.pass) << outcome.why;
}

TEST(HostileDialogTest, AVeryLongApproximateChoiceIsExact) {
  std::string words;
  for (int i = 0; i < 3000; ++i) words += "w" + std::to_string(i) + " ";
  const auto outcome = RunDoc("<menu accept=\"approximate\"><choice event=\"x\">" + words +
                                  "</choice><nomatch><pass/></nomatch></menu>",
                              {"exit: pass"}, "say w17");
  EXPECT_TRUE(outcome.pass) << outcome.why;
}

TEST(HostileXmlTest, AttributesAndNamespacesAreCounted) {
  std::string defaults, elements;
  for (int i = 0; i < 500; ++i) defaults += " a" + std::to_string(i) + " CDATA 'x'";
  EXPECT_EQ(
      vm::xml::Parse(
          "<!DOCTYPE r [<!ATTLIST e" + defaults + ">]><r>" + Times("<e/>", 2000) + "</r>", "d")
          .error()
          .code,
      vm::Errc::kLimit);
  std::string spaces;
  for (int i = 0; i < 50'000; ++i) spaces += " xmlns:n" + std::to_string(i) + "='u'";
  const auto many =
      vm::xml::Parse("<r" + spaces + ">" + Times("<n7:e><n9:f/></n7:e>", 50'000) + "</r>", "d");
  ASSERT_TRUE(many) << many.error().text;
  EXPECT_EQ(many->root->children[0]->children[0]->space, "u");
}

TEST(HostileDialogTest, RecursiveSubdialogsEnd) {
  const auto outcome = RunDoc("<form id=\"a\"><subdialog name=\"s\" src=\"#a\"/></form>",
                              {"reason: error.noresource"});
  EXPECT_TRUE(outcome.pass) << outcome.why;
}

TEST(HostileDialogTest, AHugeForeachEnds) {
  const auto outcome = RunDoc(
      "<form><block><foreach item=\"i\" array=\"new "
      "Array(10000000)\"><log>x</log></foreach></block></form>",
      {"reason: error.noresource"});
  EXPECT_TRUE(outcome.pass) << outcome.why;
}

const vxml::srgs::Grammar* Link(vxml::srgs::GrammarStore& store, const std::string& text) {
  auto made = vxml::srgs::CompileAbnf(text, {});
  EXPECT_TRUE(made) << made.error().text;
  auto added = store.Add(std::move(*made));
  EXPECT_TRUE(added);
  return *added;
}

vxml::srgs::GrammarStore NoFetch() {
  return vxml::srgs::GrammarStore([](const std::string&) -> vm::Result<std::string> {
    return vm::Fail(vm::Errc::kUnavailable, "no");
  });
}

TEST(HostileGrammarTest, ARuleOfOnlyItselfMatchesNothing) {
  auto store = NoFetch();
  const auto* grammar = Link(store, "root $a; $a = $a;");
  EXPECT_FALSE(vxml::srgs::Match(*grammar->RootRule(), "x").parse);
}

TEST(HostileGrammarTest, RepeatsOfNothingEnd) {
  auto store = NoFetch();
  const auto* grammar = Link(store, "root $a; $a = (([x]<0->)<0->)<0-> y;");
  EXPECT_TRUE(vxml::srgs::Match(*grammar->RootRule(), "x x y").parse);
}

TEST(HostileGrammarTest, ExponentialGrammarsEndInTheirLimits) {
  auto store = NoFetch();
  const auto* grammar = Link(store, "root $a; $a = $a $a $a | [x] | x [$a] | $a<0-100000>;");
  const auto result = vxml::srgs::Match(*grammar->RootRule(), Times("x ", 300));
  EXPECT_TRUE(result.parse || result.over_limit);
}

TEST(HostileGrammarTest, DeepNestingIsRefused) {
  EXPECT_FALSE(vxml::srgs::CompileAbnf(
      "root $a; $a = " + Times("(", 100'000) + "x" + Times(")", 100'000) + ";", {}));
}

TEST(HostileGrammarTest, DeepRecursionEndsInItsLimit) {
  auto store = NoFetch();
  const auto* grammar = Link(store, "root $a; $a = x [$a];");
  const auto result = vxml::srgs::Match(*grammar->RootRule(), Times("x ", 2000));
  EXPECT_TRUE(result.parse || result.over_limit);
}

}  // namespace
}  // namespace vxml_test
