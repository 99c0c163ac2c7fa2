// Scripts under their limits: what cannot be counted must not run, and regular expressions keep
// the meaning ECMA-262 gives them though another library matches them.
#include <gtest/gtest.h>

#include <chrono>
#include <ctime>

#include "task_manager/script/engine.h"
#include "task_manager/script/regexps.h"
#include "tests/task_manager/ticking_clock.h"

namespace vxml::script {
namespace {

std::string JsonOf(const std::string& expression) {
  Engine engine;
  auto value = engine.Evaluate({engine.NewScope()}, expression);
  return value ? engine.ToJson(*value) : value.error().text;
}

struct Expression {
  const char* code;
  const char* json;
};
class RegularExpression : public ::testing::TestWithParam<Expression> {};

TEST_P(RegularExpression, MeansWhatTheStandardSays) {
  EXPECT_EQ(JsonOf(GetParam().code), GetParam().json) << GetParam().code;
}

// The examples of ECMA-262 5.1, 15.10.2 and 15.5.4, and what lies near them.
INSTANTIATE_TEST_SUITE_P(
    Ecma262, RegularExpression,
    ::testing::Values(
        Expression{R"(/a|ab/.exec("abc"))", R"(["a"])"},
        Expression{R"(/((a)|(ab))((c)|(bc))/.exec("abc"))",
                   R"(["abc","a","a",null,"bc",null,"bc"])"},
        Expression{R"(/a[a-z]{2,4}/.exec("abcdefghi"))", R"(["abcde"])"},
        Expression{R"(/a[a-z]{2,4}?/.exec("abcdefghi"))", R"(["abc"])"},
        Expression{R"(/(aa|aabaac|ba|b|c)*/.exec("aabaac"))", R"(["aaba","ba"])"},
        Expression{R"("aaaaaaaaaa,aaaaaaaaaaaaaaa".replace(/^(a+)\1*,\1+$/,"$1"))", R"("aaaaa")"},
        Expression{R"(/(?=(a+))/.exec("baaabac"))", R"(["","aaa"])"},
        Expression{R"(/(?=(a+))a*b\1/.exec("baaabac"))", R"(["aba","a"])"},
        Expression{R"(/(.*?)a(?!(a+)b\2c)\2(.*)/.exec("baaabaac"))",
                   R"(["baaabaac","ba",null,"abaac"])"},
        Expression{R"("A<B>bold</B>and<CODE>coded</CODE>".split(/<(\/)?([^<>]+)>/))",
                   R"(["A",null,"B","bold","/","B","and",null,"CODE","coded","/","CODE",""])"},
        Expression{R"("ab".split(/a*?/))", R"(["a","b"])"},
        Expression{R"("ab".split(/a*/))", R"(["","b"])"}, Expression{R"("".split(/a*/))", "[]"},
        Expression{R"("a1b2c".split(/\d/, 2))", R"(["a","b"])"},
        Expression{R"("x1y22".match(/\d+/g))", R"(["1","22"])"},
        Expression{R"("abc".match(/x*/g).length)", "4"}, Expression{R"("abc".search(/c/))", "2"},
        Expression{R"("abc".search(/[]/))", "-1"}, Expression{R"(/[^]/.exec("\n"))", R"(["\n"])"},
        Expression{R"(/./.test("\u2028"))", "false"},
        Expression{R"("a\nb".match(/^b$/m)[0])", R"("b")"},
        Expression{R"(/^b$/.test("a\nb"))", "false"}, Expression{R"(/a$/.test("a\n"))", "false"},
        Expression{R"(/\bfoo\b/.test("a foo."))", "true"},
        Expression{R"(/\w/.test("\u00e9"))", "false"}, Expression{R"(/\s/.test("\u3000"))", "true"},
        Expression{R"(/[\s-x]+/.exec("a -x"))", R"([" -x"])"},
        Expression{R"(/[\]\[:alpha:]+/.exec("a]:["))", R"(["a]:["])"},
        Expression{R"(/\u3042{2}/.test("ああ"))", "true"},
        Expression{R"(/\x41\cJ\0/.test("A\n\0"))", "true"}, Expression{R"(/É/i.test("é"))", "true"},
        Expression{R"(/a{x}/.test("a{x}"))", "true"},
        Expression{R"("aXbX".replace(/x/i,"$$[$&$`$'$1]"))", R"("a$[XabX$1]bX")"},
        Expression{
            R"("abc".replace(/(b)|(z)/g,function(m,p,q,at,s){return [m,p,q,at,s].join("|")}))",
            R"("ab|b||1|abcc")"},
        Expression{
            R"((function(){var r=/a/g,s="aXa",n=[];while(r.test(s))n.push(r.lastIndex);return n;})())",
            "[1,3]"}));

double ProcessorSeconds() {
  return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

TEST(RegularExpressionTest, ThatBacktracksWithoutEndIsGivenUp) {
  Regexps regexps;
  Regexps::Spans spans;
  EXPECT_EQ(regexps.Match("^(a+)+$", "", std::u32string(60, U'a') + U"!", 0, spans),
            Regexps::Outcome::kOverLimit);
  EXPECT_EQ(regexps.Match("(x+x+)+[yz]", "", std::u32string(40, U'x'), 0, spans),
            Regexps::Outcome::kOverLimit);
  EXPECT_EQ(regexps.Match("^a+$", "", std::u32string(60, U'a'), 0, spans),
            Regexps::Outcome::kMatch);
}

TEST(RegularExpressionTest, ThatGrowsWhenCompiledIsRefused) {
  Regexps regexps;
  Regexps::Spans spans;
  EXPECT_EQ(regexps.Match("(((ab|c){900}){900}){900}", "", U"x", 0, spans),
            Regexps::Outcome::kRefused);
  EXPECT_EQ(regexps.Match("(ab){2}", "", U"xabab", 0, spans), Regexps::Outcome::kMatch);
  EXPECT_EQ(spans[0], 1);
}

TEST(RegularExpressionTest, ThatLooksForTheOtherCaseOfEveryLetterIsReadyAtOnce) {
  Regexps regexps;
  Regexps::Spans spans;
  std::string pattern;
  for (int i = 0; i < 200; ++i) pattern += "[\\W\\u0000-\\uffff].\\D?";
  EXPECT_EQ(regexps.Match(pattern, "i", std::u32string(900, U'x'), 0, spans),
            Regexps::Outcome::kMatch);
}

struct Trick {
  const char* name;
  const char* code;
};
class ScriptLimit : public ::testing::TestWithParam<Trick> {};

Limits WithTicks(std::chrono::nanoseconds tick = std::chrono::microseconds(20)) {
  Limits limits;
  limits.clocks = vxml_test::TickingClocks(tick);
  limits.steps = 500'000;
  return limits;
}

/// Not a speed test: without the guard these run for minutes or for ever; 20 s of the processor are
/// many times what the limit of one evaluation allows.
TEST_P(ScriptLimit, Holds) {
  Engine engine(WithTicks());
  const Chain chain{engine.NewScope()};
  const double before = ProcessorSeconds();
  auto ran = engine.Run(chain, GetParam().code);
  EXPECT_FALSE(ran) << GetParam().code;
  EXPECT_LT(ProcessorSeconds() - before, 20);
  auto after = engine.Evaluate(chain, "6 * 7");
  ASSERT_TRUE(after) << after.error().text;
  EXPECT_EQ(engine.ToString(*after), "42");
}

INSTANTIATE_TEST_SUITE_P(
    Tricks, ScriptLimit,
    ::testing::Values(
        Trick{"Regex", "/^(a+)+$/.test('aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa!')"},
        Trick{
            "RegexCaught",
            "var i=0; while(i++<1e6) try { /^(a+)+$/.test(Array(60).join('a')+'!') } catch(e) {}"},
        Trick{"RegexReplace",
              "'aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa!'.replace(/(a*)*[bc]/g,'')"},
        Trick{"RegexSplit",
              "'aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa!'.split(/(a|a)*[bc]/)"},
        Trick{"ForIn",
              "var o={}; for(var i=0;i<3000;i++) o['k'+i]=i;"
              "for(var a in o) for(var b in o) for(var c in o);"},
        Trick{"LongTexts", "var s='x'; while(s.length<4e6) s+=s; while(true) s.toUpperCase();"},
        Trick{
            "Getter",
            "var n=0,o={get x(){return n++<1e9 ? this.y+this.y : 0},get y(){return o.x+o.x}}; o.x"},
        Trick{"Method", "var d=0,o={f(){d++; if(d<90){o.f();o.f()} d--;}}; o.f()"},
        Trick{"Finally", "function f(){ try { while(true){} } finally { f(); f(); } } f()"},
        Trick{"OwnTick", "var __t=function(){return true}; while(true){}"},
        Trick{"TickByParameter", "(function(__t){while(true){}})(function(){return true})"},
        Trick{"TickByWith", "with({'__t':function(){return true}}) while(true){}"},
        Trick{"TickByWithLater",
              "var o={}; with(o){ o['__t']=function(){return true}; while(true){} }"},
        Trick{"EscapedName", "wh\\u0069le(true){}"}, Trick{"WideBlank", "while\u3000(true){}"},
        Trick{"CommentAndReturn", "// \r while(true){}"},
        Trick{"CommentAndSeparator", "// \u2028 while(true){}"},
        Trick{"HtmlComment", "1\n--> /*\nwhile(true){}\n//*/"},
        Trick{"DividedObject", "var x = {} / function(){while(true){}}() / 1"},
        Trick{"DividedIncrement", "var x=1; x++ / function(){while(true){}}() / 1"},
        Trick{"DividedProperty", "var x={}; x.in / function(){while(true){}}() / 1"},
        Trick{"RegexAfterHeader", "if(1) /\"/ ; while(true){} //\""},
        Trick{"RegexAfterBreak", "a: { break a\n/\"/; } while(true){} //\""}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST(ScriptTextTest, PairsOfSurrogatesLeaveTheEngineAsUtf8) {
  Engine engine;
  const auto text = [&](const std::string& code) {
    return engine.ToString(*engine.Evaluate({engine.NewScope()}, code));
  };
  EXPECT_EQ(text(R"('a\uD83D\uDE00b')"), "a\U0001F600b");
  EXPECT_EQ(text(R"('\uD83D'+'\uDE00')"), "\U0001F600");
  EXPECT_EQ(text(R"('a\uD83D' + 'b\uDE00\uD83D')"), "a\uFFFDb\uFFFD\uFFFD");
  EXPECT_EQ(JsonOf(R"(['\uD83D\uDE00'])"), "[\"\U0001F600\"]");
}

TEST(ScriptTimeTest, IsRealTimeAndThenAsMuchOfTheProcessorsExactly) {
  Limits limits = WithTicks(std::chrono::milliseconds(1));
  limits.time = std::chrono::milliseconds(100);
  Engine engine(limits);
  const Value scope = engine.NewScope();
  ASSERT_TRUE(engine.Run({scope}, "var n = 0;"));
  const auto turns = [&] {
    EXPECT_EQ(engine.Run({scope}, "n = 0; while (true) ++n;").error().code, vm::Errc::kLimit);
    return engine.ToJson(engine.Get(scope, "n"));
  };
  const std::string first = turns();
  EXPECT_GE(std::stoi(first), 100);
  EXPECT_LE(std::stoi(first), 200);
  EXPECT_EQ(turns(), first);
}

TEST(ScriptTimeTest, ABusyMachineDoesNotCountAgainstAScript) {
  Limits limits = WithTicks(std::chrono::seconds(1));  // each look finds much real time gone
  limits.clocks.processor = [] { return std::chrono::nanoseconds(0); };
  Engine engine(limits);
  EXPECT_TRUE(engine.Run({engine.NewScope()}, "for (var i = 0; i < 1000; ++i);"));
}

TEST(ScriptTimeTest, StepsAreCountedWhereTimeStandsStill) {
  Limits limits = WithTicks(std::chrono::seconds(0));
  limits.steps = 1000;
  Engine engine(limits);
  const Value scope = engine.NewScope();
  EXPECT_TRUE(engine.Run({scope}, "for (var i = 0; i < 990; ++i);"));
  EXPECT_FALSE(engine.Run({scope}, "for (var i = 0; i < 1010; ++i);"));
}

TEST(ScriptScopeTest, TheOwnNamesCannotBeTakenThroughAScopeObject) {
  Engine engine(WithTicks());
  const Value scope = engine.NewScope();
  engine.Set(scope, "dialog", scope);
  EXPECT_FALSE(engine.Run({scope}, "dialog['__t']=function(){return true}; while(true){}"));
}

TEST(ScriptScopeTest, ForInWithAndSwitchStillWork) {
  EXPECT_EQ(JsonOf("(function(){var n=[];for(var k in {a:1,b:2})n.push(k);return n})()"),
            R"(["a","b"])");
  EXPECT_EQ(JsonOf("(function(){var o={a:5};with(o){a=7}return o.a})()"), "7");
  EXPECT_EQ(JsonOf("(function(x){switch(x){case 1:return 'one';default:return 'more'}})(1)"),
            R"("one")");
  EXPECT_EQ(JsonOf("(function(){try{throw 1}catch(e){return e+1}finally{}})()"), "2");
  EXPECT_EQ(JsonOf("(function(i){return i++ / 2 + (4)/2})(4)"), "4");
  EXPECT_EQ(JsonOf("('a' in {a:1}) ? 1 : 2"), "1");
}

TEST(ScriptScopeTest, VariablesOfMethodsStayInThem) {
  Engine engine;
  const Value scope = engine.NewScope();
  ASSERT_TRUE(engine.Run({scope}, "var o={f(){var inner=1; return inner}}; var r=o.f();"));
  EXPECT_TRUE(engine.Has(scope, "r"));
  EXPECT_FALSE(engine.Has(scope, "inner"));
}

}  // namespace
}  // namespace vxml::script
