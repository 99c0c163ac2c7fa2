#include "task_manager/script/engine.h"

#include <js/Array.h>
#include <js/CallAndConstruct.h>
#include <js/CharacterEncoding.h>
#include <js/CompilationAndEvaluation.h>
#include <js/Conversions.h>
#include <js/Exception.h>
#include <js/GCAPI.h>
#include <js/GCVector.h>
#include <js/JSON.h>
#include <js/SourceText.h>
#include <jsfriendapi.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <unordered_map>

#include "embedded/prelude.h"
#include "embedded/self_hosted_code.h"
#include "task_manager/script/context.h"

namespace vxml::script {
namespace {

constexpr const char* kScriptFile = "script";
constexpr std::size_t kMaxCompiled = 1000;  // expressions kept
/// When variables hold the whole heap, handlers get this part of it more to let go of them, each
/// time it is not enough, up to so many times the whole heap. What a heap holds is known no better.
constexpr std::size_t kAllowancePart = 4;
constexpr std::size_t kMostOverrun = 4;

const JSClass kGlobalClass = {
    "global", JSCLASS_GLOBAL_FLAGS, &JS::DefaultGlobalClassOps, nullptr, nullptr, nullptr};

JSString* ToScript(JSContext* js, std::string_view text) {
  const JS::UTF8Chars utf8(text.data(), text.size());
  if (JSString* made = JS_NewStringCopyUTF8N(js, utf8)) return made;
  JS_ClearPendingException(js);
  std::size_t size = 0;
  const JS::UniqueTwoByteChars wide(
      JS::LossyUTF8CharsToNewTwoByteCharsZ(js, utf8, &size, js::MallocArena).get());
  return wide ? JS_NewUCStringCopyN(js, wide.get(), size) : nullptr;
}

bool ToId(JSContext* js, const std::string& name, JS::MutableHandleId id) {
  const JS::RootedString text(js, ToScript(js, name));
  return text && JS_StringToId(js, text, id);
}

bool FromScript(JSContext* js, JS::HandleString text, std::string& out) {
  JSLinearString* linear = JS_EnsureLinearString(js, text);
  if (!linear) return false;
  out.resize(JS::GetDeflatedUTF8StringLength(linear));
  const std::size_t written = JS::DeflateStringToUTF8Buffer(linear, mozilla::Span(out));
  out.resize(written);
  return true;
}

bool TextOf(JSContext* js, JS::HandleValue value, std::string& out) {
  const JS::RootedString text(js, JS::ToString(js, value));
  return text && FromScript(js, text, out);
}

double NumberOf(JSContext* js, JS::HandleObject object, const char* name) {
  JS::RootedValue value(js);
  return JS_GetProperty(js, object, name, &value) && value.isNumber() ? value.toNumber() : 0;
}

JSScript* Compile(JSContext* js, std::string_view source) {
  JS::CompileOptions options(js);
  options.setFileAndLine(kScriptFile, 1).setNonSyntacticScope(true);
  JS::SourceText<mozilla::Utf8Unit> text;
  if (!text.init(js, source.data(), source.size(), JS::SourceOwnership::Borrowed)) return nullptr;
  return JS::Compile(js, options, text);
}

/// Text that is no expression by itself may still become one between some brackets, as `a);(b`
/// does, but not between two kinds of them.
JSScript* CompileExpression(JSContext* js, const std::string& expression) {
  if (!Compile(js, "[" + expression + "\n]")) return nullptr;
  return Compile(js, "(" + expression + "\n)");
}

// A watched variable is a property with an accessor: the getter keeps the value, the setter knows
// the getter and the count of variables that became undefined.
constexpr std::size_t kWatchedValue = 0;   // of the getter
constexpr std::size_t kWatchedGetter = 0;  // of the setter
constexpr std::size_t kWatchedCount = 1;

bool GetWatched(JSContext*, unsigned count, JS::Value* values) {
  const JS::CallArgs arguments = JS::CallArgsFromVp(count, values);
  arguments.rval().set(js::GetFunctionNativeReserved(&arguments.callee(), kWatchedValue));
  return true;
}

bool SetWatchedValue(JSContext*, unsigned count, JS::Value* values) {
  const JS::CallArgs arguments = JS::CallArgsFromVp(count, values);
  JSObject* const setter = &arguments.callee();
  JSObject* const getter = &js::GetFunctionNativeReserved(setter, kWatchedGetter).toObject();
  js::SetFunctionNativeReserved(getter, kWatchedValue, arguments.get(0));
  if (arguments.get(0).isUndefined()) {
    ++*static_cast<std::uint64_t*>(
        js::GetFunctionNativeReserved(setter, kWatchedCount).toPrivate());
  }
  arguments.rval().setUndefined();
  return true;
}

}  // namespace

struct Value::Slot {
  Slot(JSContext* js, JS::HandleValue given) : value(js, given) {}
  JS::PersistentRootedValue value;
};

struct Engine::Impl {
  explicit Impl(const Limits& given);

  const JS::Value& Of(const Value& value) const {
    return value.slot_ ? value.slot_->value.get() : JS::UndefinedHandleValue.get();
  }
  Value Wrap(JS::HandleValue value) const {
    return Value(std::make_shared<Value::Slot>(js, value));
  }

  /// Runs `action`, which does what SpiderMonkey's functions do (false: an exception is pending or
  /// the script was stopped), within the realm and the limits, and then what promises wait for.
  template <typename Action>
  vm::Result<void> Within(Action action, vm::Errc thrown = vm::Errc::kBadValue);
  template <typename Action>
  vm::Result<Value> Make(Action action);
  /// Like Within, where `object` is an object; else nothing.
  template <typename Action>
  void WithObject(const Value& object, Action action);

  /// Takes the pending exception.
  vm::Error Failure(vm::Errc thrown);
  vm::Error Starved();
  vm::Result<void> CheckSize(const std::string& source) const;
  vm::Result<void> CheckHeap();
  /// Objects of the scripts of this thread, their texts and buffers.
  std::size_t HeapBytes() const {
    if (!memory) return 0;
    return static_cast<std::size_t>(NumberOf(js, memory, "gcBytes") +
                                    NumberOf(js, memory, "mallocBytes"));
  }
  vm::Result<JS::PersistentRootedScript*> Compiled(const std::string& expression);
  vm::Result<Value> Execute(const Chain& chain, JS::HandleScript script);
  /// Lets inner scopes see what `let`, `const` and `class` have declared in the innermost of the
  /// chain: SpiderMonkey keeps that beside the scope object, for scripts of that very scope.
  vm::Result<void> PublishLexicals(const Chain& chain);
  bool Scopes(const Chain& chain, JS::MutableHandleObjectVector out) const;

  std::shared_ptr<Context> context = Context::OfThread(embedded::self_hosted_code());
  JSContext* js = context->js();
  Limits limits;
  std::size_t most_heap_bytes = limits.heap_bytes;
  std::uint64_t cleared = 0;
  JS::PersistentRootedObject global{js};
  JS::PersistentRootedObject helpers{js};
  JS::PersistentRootedObject memory{js};  // SpiderMonkey's numbers of it
  std::unordered_map<std::string, JS::PersistentRootedScript> compiled;
};

Engine::Impl::Impl(const Limits& given) : limits(given) {
  context->set_most_heap_bytes(limits.heap_bytes);
  JS::RealmOptions options;
  options.creationOptions().setSharedMemoryAndAtomicsEnabled(false);
  if (JS_GetGCParameter(js, JSGC_BYTES) > limits.heap_bytes / 2)
    JS_GC(js);  // what former engines left
  global = JS_NewGlobalObject(js, &kGlobalClass, nullptr, JS::FireOnNewGlobalHook, options);
  const auto made = !global ? vm::Fail(vm::Errc::kLimit, "no memory") : Within([&] {
    if (!JS::InitRealmStandardClasses(js)) return false;
    const JS::RootedScript script(js, Compile(js, embedded::prelude()));
    JS::RootedValue value(js);
    if (!script || !JS_ExecuteScript(js, script, &value)) return false;
    helpers = &value.toObject();
    memory = js::gc::NewMemoryInfoObject(js);
    return memory != nullptr;
  });
  if (!made) {
    std::fprintf(stderr, "script prelude: %s\n", made.error().text.c_str());
    std::abort();
  }
}

template <typename Action>
vm::Result<void> Engine::Impl::Within(Action action, vm::Errc thrown) {
  const JSAutoRealm realm(js, global);
  context->watch().Begin(limits.time, 2 * limits.heap_bytes, limits.on_stuck);
  const bool done = action();
  std::optional<vm::Error> error;
  if (!done) error = Failure(thrown);
  done ? context->jobs().runJobs(js) : context->jobs().Drop();
  JS_ClearPendingException(js);
  const auto verdict = context->watch().End();
  if (verdict == Watch::Verdict::kLate) {
    return vm::Fail(vm::Errc::kLimit, "the script runs too long");
  }
  if (verdict == Watch::Verdict::kStarved) return std::unexpected(Starved());
  if (error) return std::unexpected(*error);
  return {};
}

template <typename Action>
vm::Result<Value> Engine::Impl::Make(Action action) {
  JS::RootedValue value(js);
  if (auto done = Within([&] { return action(&value); }); !done) {
    return std::unexpected(done.error());
  }
  return Wrap(value);
}

template <typename Action>
void Engine::Impl::WithObject(const Value& object, Action action) {
  if (!Of(object).isObject()) return;
  static_cast<void>(Within([&] {
    const JS::RootedObject inner(js, &Of(object).toObject());
    return action(inner);
  }));
}

vm::Error Engine::Impl::Failure(vm::Errc thrown) {
  if (!JS_IsExceptionPending(js)) return {vm::Errc::kLimit, "the script was stopped", 0};
  if (JS_IsThrowingOutOfMemory(js)) return Starved();
  JS::RootedValue exception(js);
  if (!JS_GetPendingException(js, &exception)) return Starved();
  JS_ClearPendingException(js);
  std::string text;
  if (!TextOf(js, exception, text)) text = "an exception that has no text";
  JS_ClearPendingException(js);
  if (exception.isObject()) {
    const JS::RootedObject object(js, &exception.toObject());
    const JSErrorReport* report = JS_ErrorFromException(js, object);
    if (report && report->lineno > 1 && std::string_view(report->filename) == kScriptFile)
      text += " (line " + std::to_string(report->lineno) + ")";
  }
  return {thrown, text, 0};
}

vm::Error Engine::Impl::Starved() {
  const JSAutoRealm realm(js, global);
  JS_ClearPendingException(js);
  JS_GC(js);
  most_heap_bytes = std::clamp(HeapBytes() + limits.heap_bytes / kAllowancePart, limits.heap_bytes,
                               kMostOverrun * limits.heap_bytes);
  context->set_most_heap_bytes(most_heap_bytes);
  return {vm::Errc::kLimit,
          "the script needs more than " + std::to_string(limits.heap_bytes >> 20) + " MiB", 0};
}

vm::Result<void> Engine::Impl::CheckHeap() {
  const JSAutoRealm realm(js, global);
  // Texts are freed beside the collection that finds them; the next one waits for that.
  for (int turn = 0; turn < 2; ++turn) {
    if (HeapBytes() <= most_heap_bytes) return {};
    JS_GC(js);
  }
  if (HeapBytes() <= most_heap_bytes) return {};
  return std::unexpected(Starved());
}

vm::Result<void> Engine::Impl::CheckSize(const std::string& source) const {
  if (source.size() <= limits.source_bytes) return {};
  return vm::Fail(vm::Errc::kLimit,
                  "a script over " + std::to_string(limits.source_bytes) + " bytes");
}

vm::Result<JS::PersistentRootedScript*> Engine::Impl::Compiled(const std::string& expression) {
  const auto known = compiled.find(expression);
  if (known != compiled.end()) return &known->second;
  if (auto small = CheckSize(expression); !small) return std::unexpected(small.error());
  JS::RootedScript script(js);
  const auto done = Within(
      [&] {
        script = CompileExpression(js, expression);
        return script != nullptr;
      },
      vm::Errc::kSyntax);
  if (!done) return std::unexpected(done.error());
  if (compiled.size() >= kMaxCompiled) compiled.clear();
  return &compiled.try_emplace(expression, js, script).first->second;
}

bool Engine::Impl::Scopes(const Chain& chain, JS::MutableHandleObjectVector out) const {
  for (auto scope = chain.rbegin(); scope != chain.rend(); ++scope) {  // the innermost is first
    if (Of(*scope).isObject() && !out.append(&Of(*scope).toObject())) return false;
  }
  return true;
}

vm::Result<Value> Engine::Impl::Execute(const Chain& chain, JS::HandleScript script) {
  auto result = Make([&](JS::MutableHandleValue value) {
    JS::RootedObjectVector scopes(js);
    return Scopes(chain, &scopes) && JS_ExecuteScript(js, scopes, script, value);
  });
  if (auto within = CheckHeap(); !within) return std::unexpected(within.error());
  return result;
}

vm::Result<void> Engine::Impl::PublishLexicals(const Chain& chain) {
  if (chain.empty() || !Of(chain.back()).isObject()) return {};
  const JS::RootedObject scope(js, &Of(chain.back()).toObject());
  if (!JS_HasExtensibleLexicalEnvironment(scope)) return {};
  return Within([&] {
    const JS::RootedObject lexicals(js, JS_ExtensibleLexicalEnvironment(scope));
    JS::Rooted<JS::IdVector> ids(js, JS::IdVector(js));
    if (!JS_Enumerate(js, lexicals, &ids)) return false;
    JS::RootedObjectVector scopes(js);
    if (!Scopes(chain, &scopes)) return false;
    for (std::size_t i = 0; i < ids.length(); ++i) {
      bool known = false;
      if (!JS_HasOwnPropertyById(js, scope, ids[i], &known)) return false;
      if (known) continue;
      JS::RootedValue name(js), pair(js), get(js), set(js);
      std::string text;
      if (!JS_IdToValue(js, ids[i], &name) || !TextOf(js, name, text)) return false;
      const JS::RootedScript script(
          js, Compile(js, "({get: () => " + text + ", set() { " + text + " = arguments[0]; }})"));
      if (!script || !JS_ExecuteScript(js, scopes, script, &pair)) return false;
      const JS::RootedObject accessors(js, &pair.toObject());
      if (!JS_GetProperty(js, accessors, "get", &get) ||
          !JS_GetProperty(js, accessors, "set", &set)) {
        return false;
      }
      const JS::RootedObject getter(js, &get.toObject()), setter(js, &set.toObject());
      if (!JS_DefinePropertyById(js, scope, ids[i], getter, setter, 0)) return false;
    }
    return true;
  });
}

Engine::Engine(const Limits& limits) : impl_(std::make_unique<Impl>(limits)) {}
Engine::~Engine() = default;

// --- running

vm::Result<Value> Engine::Evaluate(const Chain& chain, const std::string& expression) {
  auto script = impl_->Compiled(expression);
  if (!script) return std::unexpected(script.error());
  return impl_->Execute(chain, **script);
}

vm::Result<void> Engine::Run(const Chain& chain, const std::string& source) {
  if (auto small = impl_->CheckSize(source); !small) return small;
  JSContext* js = impl_->js;
  JS::RootedScript script(js);
  const auto compile = [&] { return (script = Compile(js, source)) != nullptr; };
  if (auto done = impl_->Within(compile, vm::Errc::kSyntax); !done) return done;
  auto result = impl_->Execute(chain, script);
  auto published = impl_->PublishLexicals(chain);  // what was declared before an error, too
  if (!result) return std::unexpected(result.error());
  return published;
}

vm::Result<void> Engine::Assign(const Chain& chain, const std::string& path, const Value& value) {
  if (auto fit = CheckExpression(path); !fit) return fit;
  JSContext* js = impl_->js;
  const std::string body = "'use strict';(" + path + "\n)=assigned";
  return impl_->Within([&] {
    JS::CompileOptions options(js);
    options.setFileAndLine("assign", 1);
    const char* const parameters[] = {"assigned"};
    JS::SourceText<mozilla::Utf8Unit> text;
    JS::RootedObjectVector scopes(js);
    if (!impl_->Scopes(chain, &scopes) ||
        !text.init(js, body.data(), body.size(), JS::SourceOwnership::Borrowed)) {
      return false;
    }
    const JS::RootedFunction function(
        js, JS::CompileFunction(js, scopes, options, "assign", 1, parameters, text));
    JS::RootedValueVector arguments(js);
    JS::RootedValue result(js);
    return function && arguments.append(impl_->Of(value)) &&
           JS_CallFunction(js, nullptr, function, arguments, &result);
  });
}

vm::Result<void> Engine::CheckExpression(const std::string& expression) {
  auto script = impl_->Compiled(expression);
  if (!script) return std::unexpected(script.error());
  return {};
}

vm::Result<void> Engine::CheckScript(const std::string& script) {
  if (auto small = impl_->CheckSize(script); !small) return small;
  return impl_->Within([&] { return Compile(impl_->js, script) != nullptr; }, vm::Errc::kSyntax);
}

bool Engine::IsIdentifier(const std::string& text) {
  bool is = false;
  static_cast<void>(impl_->Within([&] {
    const JS::RootedString name(impl_->js, ToScript(impl_->js, text));
    return name && JS_IsIdentifier(impl_->js, name, &is);
  }));
  return is && CheckScript("var " + text);
}

bool Engine::IsDeclared(const Chain& chain, const std::string& identifier) {
  for (const Value& scope : chain) {
    if (Has(scope, identifier)) return true;
  }
  bool built_in = false;
  JSContext* js = impl_->js;
  static_cast<void>(impl_->Within([&] {
    JS::RootedId id(js);
    JS::Rooted<mozilla::Maybe<JS::PropertyDescriptor>> found(js);
    if (!ToId(js, identifier, &id) ||
        !JS_GetOwnPropertyDescriptorById(js, impl_->global, id, &found)) {
      return false;
    }
    built_in = found.isSome() && !found->enumerable();
    return true;
  }));
  return !built_in && IsIdentifier(identifier) && Evaluate(chain, identifier).has_value();
}

// --- making values

Value Engine::NewScope() {
  return impl_
      ->Make([&](JS::MutableHandleValue value) {
        JSObject* made = JS_NewObjectWithGivenProto(impl_->js, nullptr, nullptr);
        if (made) value.setObject(*made);
        return made != nullptr;
      })
      .value_or(Value());
}
Value Engine::Undefined() { return impl_->Wrap(JS::UndefinedHandleValue); }
Value Engine::Null() { return impl_->Wrap(JS::NullHandleValue); }
Value Engine::String(std::string_view text) {
  return impl_
      ->Make([&](JS::MutableHandleValue value) {
        JSString* made = ToScript(impl_->js, text);
        if (made) value.setString(made);
        return made != nullptr;
      })
      .value_or(Value());
}
Value Engine::Number(double number) {
  return impl_->Wrap(JS::RootedValue(impl_->js, JS::NumberValue(number)));
}
Value Engine::Boolean(bool truth) {
  return impl_->Wrap(truth ? JS::TrueHandleValue : JS::FalseHandleValue);
}
vm::Result<Value> Engine::Json(const std::string& json) {
  return impl_->Make([&](JS::MutableHandleValue value) {
    const JS::RootedString text(impl_->js, ToScript(impl_->js, json));
    return text && JS_ParseJSON(impl_->js, text, value);
  });
}
vm::Result<Value> Engine::Dom(const std::string& json) {
  return impl_->Make([&](JS::MutableHandleValue value) {
    const JS::RootedString text(impl_->js, ToScript(impl_->js, json));
    JS::RootedValue parsed(impl_->js);
    return text && JS_ParseJSON(impl_->js, text, &parsed) &&
           JS_CallFunctionName(impl_->js, impl_->helpers, "dom", JS::HandleValueArray(parsed),
                               value);
  });
}
Value Engine::Copy(const Value& array) {
  auto made = impl_->Make([&](JS::MutableHandleValue value) {
    value.setUndefined();
    if (!impl_->Of(array).isObject()) return true;
    const JS::RootedObject object(impl_->js, &impl_->Of(array).toObject());
    return JS_CallFunctionName(impl_->js, object, "slice", JS::HandleValueArray::empty(), value);
  });
  return made ? *made : Array();
}

// --- looking into values

bool Engine::Has(const Value& object, const std::string& name) {
  bool has = false;
  impl_->WithObject(object, [&](JS::HandleObject inner) {
    JS::RootedId id(impl_->js);
    return ToId(impl_->js, name, &id) && JS_HasPropertyById(impl_->js, inner, id, &has);
  });
  return has;
}
Value Engine::Get(const Value& object, const std::string& name) {
  const JS::Value& from = impl_->Of(object);
  if (from.isNullOrUndefined()) return Undefined();
  return impl_
      ->Make([&](JS::MutableHandleValue value) {
        const JS::RootedValue rooted(impl_->js, from);
        const JS::RootedObject inner(impl_->js, JS::ToObject(impl_->js, rooted));
        JS::RootedId id(impl_->js);
        return inner && ToId(impl_->js, name, &id) &&
               JS_GetPropertyById(impl_->js, inner, id, value);
      })
      .value_or(Value());
}
void Engine::Set(const Value& object, const std::string& name, const Value& value) {
  impl_->WithObject(object, [&](JS::HandleObject inner) {
    JS::RootedId id(impl_->js);
    const JS::RootedValue rooted(impl_->js, impl_->Of(value));
    return ToId(impl_->js, name, &id) && JS_SetPropertyById(impl_->js, inner, id, rooted);
  });
}
void Engine::SetReadOnly(const Value& object, const std::string& name, const Value& value) {
  impl_->WithObject(object, [&](JS::HandleObject inner) {
    JS::RootedId id(impl_->js);
    const JS::RootedValue rooted(impl_->js, impl_->Of(value));
    return ToId(impl_->js, name, &id) &&
           JS_DefinePropertyById(impl_->js, inner, id, rooted,
                                 JSPROP_ENUMERATE | JSPROP_READONLY | JSPROP_PERMANENT);
  });
}
void Engine::Freeze(const Value& object) {
  impl_->WithObject(object,
                    [&](JS::HandleObject inner) { return JS_FreezeObject(impl_->js, inner); });
}
std::vector<std::string> Engine::Keys(const Value& object) {
  std::vector<std::string> keys;
  impl_->WithObject(object, [&](JS::HandleObject inner) {
    JS::Rooted<JS::IdVector> ids(impl_->js, JS::IdVector(impl_->js));
    if (!JS_Enumerate(impl_->js, inner, &ids)) return false;
    for (std::size_t i = 0; i < ids.length(); ++i) {
      JS::RootedValue name(impl_->js);
      if (!JS_IdToValue(impl_->js, ids[i], &name) ||
          !TextOf(impl_->js, name, keys.emplace_back())) {
        return false;
      }
    }
    return true;
  });
  return keys;
}
std::size_t Engine::Length(const Value& array) {
  const Value length = Get(array, "length");
  const JS::Value& value = impl_->Of(length);
  const double number = value.isNumber() && IsObject(array) ? value.toNumber() : 0;
  return number > 0 && number <= UINT32_MAX ? static_cast<std::size_t>(number) : 0;
}

void Engine::SetWatched(const Value& scope, const std::string& name, const Value& value) {
  impl_->WithObject(scope, [&](JS::HandleObject inner) {
    JSContext* js = impl_->js;
    JS::RootedId id(js);
    const JS::RootedFunction get(js, js::NewFunctionWithReserved(js, GetWatched, 0, 0, "get"));
    const JS::RootedFunction set(js, js::NewFunctionWithReserved(js, SetWatchedValue, 1, 0, "set"));
    if (!get || !set || !ToId(js, name, &id)) return false;
    const JS::RootedObject getter(js, JS_GetFunctionObject(get));
    const JS::RootedObject setter(js, JS_GetFunctionObject(set));
    js::SetFunctionNativeReserved(getter, kWatchedValue, impl_->Of(value));
    js::SetFunctionNativeReserved(setter, kWatchedGetter, JS::ObjectValue(*getter));
    js::SetFunctionNativeReserved(setter, kWatchedCount, JS::PrivateValue(&impl_->cleared));
    return JS_DefinePropertyById(js, inner, id, getter, setter,
                                 JSPROP_ENUMERATE | JSPROP_PERMANENT);
  });
}
std::uint64_t Engine::cleared() const { return impl_->cleared; }

bool Engine::IsUndefined(const Value& value) { return impl_->Of(value).isUndefined(); }
bool Engine::IsObject(const Value& value) { return impl_->Of(value).isObject(); }
bool Engine::IsArray(const Value& value) {
  bool is = false;
  impl_->WithObject(
      value, [&](JS::HandleObject inner) { return JS::IsArrayObject(impl_->js, inner, &is); });
  return is;
}
bool Engine::ToBoolean(const Value& value) {
  return JS::ToBoolean(JS::RootedValue(impl_->js, impl_->Of(value)));
}
vm::Result<std::string> Engine::Text(const Value& value) {
  std::string text;
  const auto done = impl_->Within(
      [&] { return TextOf(impl_->js, JS::RootedValue(impl_->js, impl_->Of(value)), text); });
  if (!done) return std::unexpected(done.error());
  return text;
}
std::string Engine::ToString(const Value& value) {
  auto text = Text(value);
  return text ? *text : text.error().text;
}
std::string Engine::ToJson(const Value& value) {
  std::string text;
  const auto done = impl_->Within([&] {
    const JS::RootedValue given(impl_->js, impl_->Of(value));
    JS::RootedValue made(impl_->js);
    return JS_CallFunctionName(impl_->js, impl_->helpers, "json", JS::HandleValueArray(given),
                               &made) &&
           TextOf(impl_->js, made, text);
  });
  return done ? text : "\"[object]\"";
}

}  // namespace vxml::script
