// Scripts in their scopes and under their limits.
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

#include "task_manager/script/engine.h"

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

struct Trick {
  const char* name;
  const char* code;
};
class ScriptLimit : public ::testing::TestWithParam<Trick> {};

Limits Small() {
  Limits limits;
  limits.heap_bytes = std::size_t{8} << 20;
  limits.time = std::chrono::milliseconds(100);
  return limits;
}

TEST_P(ScriptLimit, EndsTheScriptAndTheEngineGoesOn) {
  Engine engine(Small());
  const Chain chain{engine.NewScope()};
  EXPECT_FALSE(engine.Run(chain, GetParam().code)) << GetParam().code;
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
        Trick{"FinallyReturns", "for(;;) (() => { try { for(;;); } finally { return 1 } })()"},
        Trick{"Generator", "for (const x of (function*(){ for(;;) yield 1 })());"},
        Trick{"Promise", "(function again(){ Promise.resolve().then(again) })(); for(;;);"},
        Trick{"JobWithoutEnd", "(async () => { await 1; for(;;); })()"},
        Trick{"Proxy", "for (const k in new Proxy({}, {ownKeys(){ for(;;); }}));"},
        Trick{"ToStringWithoutEnd", "throw {toString(){ for(;;); }}"},
        Trick{"SortWithoutOrder", "Array(1e6).fill(1).sort(() => { for(;;); })"},
        Trick{"CodeTooLong", "eval('1;'.repeat(1e7))"},
        Trick{"BracketsInCode", "eval('('.repeat(5e5))"},
        Trick{"Map", "const m = new Map; for (let i = 0; ; ++i) m.set(i, 'x' + i)"},
        Trick{"Buffers", "(() => { const z = []; for (;;) z.push(new ArrayBuffer(1e7)); })()"},
        Trick{"TextsOutsideTheHeap",
              "const t = []; for (;;) t.push(('x'.repeat(1e6) + t.length).replace('q', ''))"},
        Trick{"WebAssembly", "new WebAssembly.Memory({initial: 1000})"},
        Trick{"SharedMemory", "new SharedArrayBuffer(8)"}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST(ScriptLimitTest, WhatVariablesHoldCountsOverAllEvaluations) {
  Engine engine(Small());
  const Chain chain{engine.NewScope()};
  ASSERT_TRUE(engine.Run(chain, "var held = []"));
  vm::Result<Value> grown;
  for (int i = 0; i < 50 && (i == 0 || grown); ++i) {
    grown = engine.Evaluate(chain, "held.push(('x'.repeat(1e6) + held.length).replace('q', ''))");
  }
  ASSERT_FALSE(grown);
  EXPECT_EQ(grown.error().code, vm::Errc::kLimit);
  const auto freed = engine.Run(chain, "held = null");
  EXPECT_TRUE(freed) << freed.error().text;
  EXPECT_TRUE(engine.Evaluate(chain, "('x'.repeat(1e6) + 'y').replace('q', '')"));
}

TEST(ScriptLimitTest, AnExpressionIsNothingElse) {
  Engine engine;
  for (const char* code : {"1);(2", "1];[2", "a) => (b", "", "var x", "1;", "{", "//", "...[1]"}) {
    const auto value = engine.Evaluate({engine.NewScope()}, code);
    ASSERT_FALSE(value) << code;
    EXPECT_EQ(value.error().code, vm::Errc::kSyntax) << code;
  }
  EXPECT_EQ(JsonOf("1 // one"), "1");
}

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

TEST(ScriptScopeTest, EachDeclarationGoesToTheInnermostScopeAndFunctionsKeepTheirs) {
  Engine engine;
  const Value outer = engine.NewScope(), inner = engine.NewScope();
  ASSERT_TRUE(engine.Run({outer}, "var a = 1; let b = 2; const c = 3; class D { e = 4 }"));
  ASSERT_TRUE(engine.Run({outer, inner}, "var f = () => a + b + c + new D().e; var a = 10;"));
  EXPECT_EQ(engine.ToJson(*engine.Evaluate({outer, inner}, "f()")), "19");
  EXPECT_EQ(engine.ToJson(*engine.Evaluate({outer}, "a + b")), "3");
  EXPECT_EQ(engine.Keys(outer), std::vector<std::string>{"a"});
  EXPECT_TRUE(engine.IsDeclared({outer, inner}, "b"));
  EXPECT_FALSE(engine.IsDeclared({outer, inner}, "g"));
  EXPECT_FALSE(engine.IsDeclared({outer, inner}, "Math"));
}

TEST(ScriptScopeTest, WhatIsReadOnlyOrMissingCannotBeAssigned) {
  Engine engine;
  const Value scope = engine.NewScope();
  engine.SetReadOnly(scope, "session", engine.Object());
  ASSERT_TRUE(engine.Run({scope}, "var list = [1, {}]"));
  const auto assigned = [&](const char* path) {
    return engine.Assign({scope}, path, engine.Number(7)).has_value();
  };
  EXPECT_TRUE(assigned("list[1].x"));
  EXPECT_TRUE(assigned("list"));
  for (const char* path :
       {"session", "nobody", "nobody.x", "1", "list = 2", "list, list", "f()", "list)=3;(list"}) {
    EXPECT_FALSE(assigned(path)) << path;
  }
  ASSERT_TRUE(engine.Run({scope}, "session = 3"));
  EXPECT_EQ(engine.ToJson(engine.Get(scope, "session")), "{}");
}

TEST(ScriptScopeTest, PromisesAreSettledBeforeTheNextEvaluation) {
  Engine engine;
  const Value scope = engine.NewScope();
  ASSERT_TRUE(engine.Run({scope}, "var x = 0; (async () => { await 1; await 2; x = 3 })()"));
  EXPECT_EQ(engine.ToJson(engine.Get(scope, "x")), "3");
}

TEST(ScriptErrorTest, NamesTheLineOfALongerScript) {
  Engine engine;
  const auto ran = engine.Run({engine.NewScope()}, "var a = 1;\nvar b = 2;\nnobody();");
  ASSERT_FALSE(ran);
  EXPECT_EQ(ran.error().text, "ReferenceError: nobody is not defined (line 3)");
}

TEST(ScriptJsonTest, ShowsWhatJsonHasNoWordFor) {
  EXPECT_EQ(JsonOf("undefined"), "undefined");
  EXPECT_EQ(JsonOf("({f: 5n, g: [undefined]})"), R"({"f":"5","g":[null]})");
  EXPECT_EQ(JsonOf("(() => { const a = {b: {}}; a.b.c = a; a.d = a.b; return a })()"),
            R"({"b":{"c":"[cycle]"},"d":{"c":"[cycle]"}})");
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
