// What ECMAScript 2015 to 2022 added to the language, feature by feature: a dialogue's scripts may
// use all of it. Each probe runs as the <script> of a document would and is true.
#include <gtest/gtest.h>

#include "task_manager/script/engine.h"

namespace vxml::script {
namespace {

struct Probe {
  const char* name;
  const char* script;  ///< sets `ok`
};

class EcmaScript : public testing::TestWithParam<Probe> {};

TEST_P(EcmaScript, IsUnderstood) {
  Engine engine;
  const Chain chain{engine.NewScope()};
  engine.Set(chain.back(), "ok", engine.Boolean(false));
  const auto ran = engine.Run(chain, GetParam().script);
  ASSERT_TRUE(ran) << ran.error().text;
  const auto ok = engine.Evaluate(chain, "ok");  // promises are settled before
  ASSERT_TRUE(ok) << ok.error().text;
  EXPECT_TRUE(engine.ToBoolean(*ok)) << GetParam().script;
}

constexpr Probe kProbes[] = {
    // ECMAScript 2015
    {"Arrow", "var f = (a, b) => a + b; ok = f(1, 2) === 3"},
    {"ArrowThis", "var o = {n: 4, f() { return [1].map(() => this.n)[0]; }}; ok = o.f() === 4"},
    {"Let", "{ let a = 1; { let a = 2; } ok = a === 1; }"},
    {"LetInLoops", "var f = []; for (let i = 0; i < 2; i++) f.push(() => i); ok = f[0]() === 0"},
    {"Const", "const c = 1; try { c = 2; } catch (e) { ok = e instanceof TypeError; }"},
    {"TemplateLiteral", "var n = 2; ok = `a${n + 1}b` === 'a3b'"},
    {"TaggedTemplate", "var t = (s, ...v) => s.raw[0] + v[0]; ok = t`\\n${1}` === '\\\\n1'"},
    {"ArrayDestructuring",
     "var [a, , b = 5, ...c] = [1, 2, undefined, 4]; ok = a + b + c[0] === 10"},
    {"ObjectDestructuring",
     "var {a, b: {c = 3}, ...d} = {a: 1, b: {}, e: 2}; ok = a + c + d.e === 6"},
    {"ParameterDestructuring", "ok = (({x}, [y]) => x * y)({x: 2}, [3]) === 6"},
    {"DefaultParameter", "ok = ((a, b = a * 2) => b)(4) === 8"},
    {"RestParameter", "ok = ((...a) => a.length)(1, 2, 3) === 3"},
    {"SpreadInCall", "ok = Math.max(...[1, 5, 3]) === 5"},
    {"SpreadInArray", "ok = [0, ...'ab', 1].length === 4"},
    {"ShorthandProperty", "var x = 1; var o = {x, f() { return 2; }}; ok = o.x + o.f() === 3"},
    {"ComputedProperty", "var k = 'z'; ok = ({[k + 1]: 7}).z1 === 7"},
    {"Class",
     "class A { constructor(n) { this.n = n; } m() { return this.n; } } ok = new A(3).m() === 3"},
    {"ClassInheritance",
     "class A { m() { return 1; } } class B extends A { m() { return super.m() + 1; } } ok = new "
     "B().m() === 2"},
    {"ClassStatic", "class A { static s() { return 5; } } ok = A.s() === 5"},
    {"Accessor",
     "class A { get v() { return 6; } set v(x) { this.w = x; } } var a = new A(); a.v = 2; ok = "
     "a.v + a.w === 8"},
    {"NewTarget", "function F() { return {t: new.target === F}; } ok = new F().t"},
    {"ForOf", "var s = 0; for (const x of [1, 2, 3]) s += x; ok = s === 6"},
    {"Iterator",
     "var o = {*[Symbol.iterator]() { yield 1; yield 2; }}; ok = [...o].join() === '1,2'"},
    {"Generator",
     "function* g() { const x = yield 1; yield x * 2; } var i = g(); i.next(); ok = "
     "i.next(4).value === 8"},
    {"YieldDelegation", "function* a() { yield* [1, 2]; } ok = [...a()].length === 2"},
    {"Map", "var m = new Map([['a', 1]]); m.set({}, 2); ok = m.size === 2 && m.get('a') === 1"},
    {"Set", "ok = new Set([1, 1, 2]).size === 2"},
    {"WeakMap", "var k = {}; var w = new WeakMap([[k, 3]]); ok = w.get(k) === 3"},
    {"WeakSet", "var k = {}; ok = new WeakSet([k]).has(k)"},
    {"Symbol", "var s = Symbol('d'); ok = ({[s]: 1})[s] === 1 && s.toString() === 'Symbol(d)'"},
    {"Promise", "Promise.resolve(1).then(() => { ok = true; })"},
    {"PromiseAll", "Promise.all([1, Promise.resolve(2)]).then(v => { ok = v[1] === 2; })"},
    {"Proxy", "ok = new Proxy({}, {get: (t, k) => k + '!'}).a === 'a!'"},
    {"Reflect", "ok = Reflect.ownKeys({a: 1, b: 2}).length === 2"},
    {"TypedArray", "ok = new Uint8Array([1, 300])[1] === 44"},
    {"DataView",
     "var d = new DataView(new ArrayBuffer(4)); d.setInt16(0, 258); ok = d.getUint8(1) === 2"},
    {"BinaryLiteral", "ok = 0b101 + 0o17 === 20"},
    {"UnicodeEscape", "ok = '\\u{1F600}'.length === 2 && '\\u{1F600}'.codePointAt(0) === 0x1F600"},
    {"RegExpSticky", "var r = /a/y; r.lastIndex = 1; ok = r.test('ba') && !r.test('ba')"},
    {"RegExpUnicode", "ok = /^.$/u.test('\\u{1F600}')"},
    {"StringMethods",
     "ok = 'abc'.includes('b') && 'abc'.startsWith('a') && 'abc'.endsWith('c') && 'ab'.repeat(2) "
     "=== 'abab'"},
    {"StringNormalize", "ok = '\\u0041\\u030A'.normalize('NFC') === '\\u00C5'"},
    {"ArrayMethods",
     "ok = [1, 2, 3].find(x => x > 1) === 2 && [1, 2].findIndex(x => x === 2) === 1 && "
     "Array.from('ab').length === 2 && Array.of(7)[0] === 7 && [1, 2].fill(0)[1] === 0"},
    {"ObjectAssign", "ok = Object.assign({a: 1}, {b: 2}).b === 2 && Object.is(NaN, NaN)"},
    {"NumberMethods",
     "ok = Number.isInteger(3) && Number.isNaN(NaN) && Number.EPSILON > 0 && Math.trunc(-1.5) === "
     "-1 && Math.sign(-3) === -1 && Math.hypot(3, 4) === 5"},
    {"BlockFunction", "'use strict'; { function f() { return 1; } } ok = typeof f === 'undefined'"},
    {"StrictMode",
     "(function () { 'use strict'; try { undeclared = 1; } catch (e) { ok = e instanceof "
     "ReferenceError; } })()"},
    // ECMAScript 2016 to 2019
    {"ArrayIncludes", "ok = [1, NaN].includes(NaN)"},
    {"Exponent", "var x = 2; x **= 3; ok = x ** 2 === 64"},
    {"AsyncFunction", "(async () => { const v = await Promise.resolve(3); ok = v === 3; })()"},
    {"ObjectEntries", "ok = Object.entries({a: 1})[0][1] === 1 && Object.values({a: 2})[0] === 2"},
    {"StringPadding", "ok = '7'.padStart(3, '0') === '007' && 'a'.padEnd(2) === 'a '"},
    {"PropertyDescriptors", "ok = Object.getOwnPropertyDescriptors({a: 1}).a.value === 1"},
    {"TrailingComma", "ok = ((a, b,) => a + b)(1, 2,) === 3"},
    {"ObjectSpread", "ok = ({...{a: 1, b: 2}, b: 3}).b === 3"},
    {"AsyncIteration",
     "(async () => { let s = 0; for await (const x of [1, Promise.resolve(2)]) s += x; ok = s === "
     "3; })()"},
    {"PromiseFinally", "Promise.resolve().finally(() => { ok = true; })"},
    {"NamedGroup", "ok = /(?<year>\\d{4})/.exec('in 2026').groups.year === '2026'"},
    {"LookBehind", "ok = /(?<=\\$)\\d+/.exec('$42')[0] === '42'"},
    {"DotAll", "ok = /a.b/s.test('a\\nb')"},
    {"UnicodeProperty", "ok = /^\\p{Script=Hiragana}+$/u.test('\\u3042')"},
    {"ArrayFlat",
     "ok = [1, [2, [3]]].flat(2).length === 3 && [1, 2].flatMap(x => [x, x]).length === 4"},
    {"ObjectFromEntries", "ok = Object.fromEntries([['a', 1]]).a === 1"},
    {"StringTrim", "ok = ' a '.trimStart() === 'a ' && ' a '.trimEnd() === ' a'"},
    {"OptionalCatch", "try { throw 1; } catch { ok = true; }"},
    // ECMAScript 2020 to 2022
    {"OptionalChaining",
     "var o = {a: null}; ok = o.a?.b.c === undefined && o.f?.() === undefined && o?.['a'] === "
     "null"},
    {"NullishCoalescing", "ok = (0 ?? 5) === 0 && (null ?? 5) === 5"},
    {"BigInt", "ok = 2n ** 64n === 18446744073709551616n"},
    {"GlobalThis", "ok = typeof globalThis === 'object'"},
    {"MatchAll", "ok = [...'a1b2'.matchAll(/\\d/g)].length === 2"},
    {"PromiseAllSettled",
     "Promise.allSettled([Promise.reject(1)]).then(r => { ok = r[0].status === 'rejected'; })"},
    {"LogicalAssignment", "var a = null, b = 1; a ?\?= 4; b &&= 2; ok = a + b === 6"},
    {"ReplaceAll", "ok = 'a.a'.replaceAll('a', 'b') === 'b.b'"},
    {"PromiseAny", "Promise.any([Promise.reject(1), 2]).then(v => { ok = v === 2; })"},
    {"NumericSeparator", "ok = 1_000 === 1000"},
    {"ClassFields", "class A { x = 1; static y = 2; } ok = new A().x + A.y === 3"},
    {"PrivateMembers",
     "class A { #p = 4; #m() { return this.#p; } v() { return #p in this && this.#m(); } } ok = "
     "new A().v() === 4"},
    {"StaticBlock", "class A { static { A.z = 9; } } ok = A.z === 9"},
    {"At", "ok = [1, 2].at(-1) === 2 && 'ab'.at(-1) === 'b'"},
    {"HasOwn", "ok = Object.hasOwn({a: 1}, 'a')"},
    {"ErrorCause", "ok = new Error('x', {cause: 3}).cause === 3"},
    {"MatchIndices", "ok = /b/d.exec('ab').indices[0][0] === 1"},
};

/// What shows when memory is collected, or works on several threads, is left out on purpose: the
/// same dialogue is to take the same course each time.
TEST(EcmaScriptTest, WhatIsNotReproducibleIsNotThere) {
  Engine engine;
  const Chain chain{engine.NewScope()};
  for (const char* name :
       {"WeakRef", "FinalizationRegistry", "SharedArrayBuffer", "Atomics", "WebAssembly"}) {
    const auto type = engine.Evaluate(chain, std::string("typeof ") + name);
    ASSERT_TRUE(type);
    EXPECT_EQ(engine.ToString(*type), "undefined") << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Features, EcmaScript, testing::ValuesIn(kProbes),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace vxml::script
