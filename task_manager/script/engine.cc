#include "task_manager/script/engine.h"

#include <duktape.h>

#include <cstdlib>
#include <cstring>

#include "embedded/prelude.h"
#include "task_manager/script/rewriter.h"

namespace vxml::script {
namespace {

constexpr duk_size_t kMaxCached = 2000;
constexpr const char* kValues = "v";
constexpr const char* kCache = "c";

struct BlockHeader {
  std::size_t size;
  std::size_t pad;  // keeps the block behind it aligned
};

}  // namespace

struct Engine::Impl {
  explicit Impl(const Limits& given) : limits(given) {
    context = duk_create_heap(&Allocate, &Reallocate, &Release, this, &Fatal);
    if (!context) std::abort();
    Protect([](duk_context* c) {
      duk_push_heap_stash(c);
      duk_push_array(c);
      duk_put_prop_string(c, -2, kValues);
      duk_push_object(c);
      duk_put_prop_string(c, -2, kCache);
      duk_push_c_function(c, &Tick, 0);
      duk_put_global_string(c, "__t");
      duk_push_c_function(c, &Eval, 1);
      duk_put_global_string(c, "__eval");
    });
    const std::string_view prelude = embedded::prelude();
    ok = Protect([&](duk_context* c) { duk_eval_lstring(c, prelude.data(), prelude.size()); });
  }
  ~Impl() { duk_destroy_heap(context); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  // --- memory: counted, refused over the limit

  static void* Allocate(void* self, duk_size_t size) { return Reallocate(self, nullptr, size); }
  static void* Reallocate(void* self, void* old, duk_size_t size) {
    auto& impl = *static_cast<Impl*>(self);
    auto* header = old ? static_cast<BlockHeader*>(old) - 1 : nullptr;
    const std::size_t had = header ? header->size : 0;
    if (size == 0) {
      Release(self, old);
      return nullptr;
    }
    if (size > had && impl.used + (size - had) > impl.limits.heap_bytes + impl.allowance) {
      impl.starved = true;
      return nullptr;
    }
    auto* block = static_cast<BlockHeader*>(std::realloc(header, sizeof(BlockHeader) + size));
    if (!block) return nullptr;
    impl.used = impl.used - had + size;
    block->size = size;
    return block + 1;
  }
  static void Release(void* self, void* old) {
    if (!old) return;
    auto* header = static_cast<BlockHeader*>(old) - 1;
    static_cast<Impl*>(self)->used -= header->size;
    std::free(header);
  }
  static void Fatal(void*, const char* message) {
    // Only reached by a fault of ours: every call into the engine is protected.
    std::fputs(message, stderr);
    std::abort();
  }

  // --- time

  static Impl& From(duk_context* c) {
    duk_memory_functions functions;
    duk_get_memory_functions(c, &functions);
    return *static_cast<Impl*>(functions.udata);
  }
  static duk_ret_t Tick(duk_context* c) {
    Impl& impl = From(c);
    const bool late =
        impl.steps_left % 1024 == 0 && std::chrono::steady_clock::now() > impl.deadline;
    if (impl.steps_left == 0 || late) {
      impl.steps_left = 0;
      impl.out_of_time = true;
      return duk_error(c, DUK_ERR_RANGE_ERROR, "the script runs too long");
    }
    --impl.steps_left;
    duk_push_true(c);
    return 1;
  }
  void StartBudget() {
    if (nesting > 0) return;
    steps_left = limits.steps;
    deadline = std::chrono::steady_clock::now() + limits.time;
    starved = out_of_time = false;
  }

  // --- protected calls

  /// Runs `action`, which leaves one result (or nothing) on the stack; the stack is restored after.
  template <typename Action>
  bool Protect(Action action) {
    const auto trampoline = [](duk_context* c, void* data) -> duk_ret_t {
      (*static_cast<Action*>(data))(c);
      return 0;
    };
    StartBudget();
    ++nesting;
    const duk_int_t failed = duk_safe_call(context, trampoline, &action, 0, 1);
    --nesting;
    if (failed != DUK_EXEC_SUCCESS) {
      const char* text = duk_safe_to_string(context, -1);
      error_text = text ? text : "unknown error";
    }
    duk_pop(context);
    return failed == DUK_EXEC_SUCCESS;
  }

  vm::Error Failure() {
    if (out_of_time || starved) {
      const std::string why = out_of_time ? "the script runs too long"
                                          : "the script needs more than " +
                                                std::to_string(limits.heap_bytes >> 20) + " MiB";
      // Variables may hold the whole heap: handlers get a little more, a few times, to let go of
      // them.
      if (starved && allowance < limits.heap_bytes / 4) allowance += std::size_t{256} << 10;
      duk_gc(context, 0);
      return {vm::Errc::kLimit, why, 0};
    }
    const bool syntax = error_text.starts_with("SyntaxError");
    return {syntax ? vm::Errc::kSyntax : vm::Errc::kBadValue, error_text, 0};
  }

  // --- values are elements of an array in the stash

  void PushSlot(duk_context* c, duk_uarridx_t index) const {
    duk_push_heap_stash(c);
    duk_get_prop_string(c, -1, kValues);
    duk_get_prop_index(c, -1, index);
    duk_replace(c, -3);
    duk_pop(c);
  }
  /// Takes the value on top into slot `index`.
  static void StoreTop(duk_context* c, duk_uarridx_t index) {
    duk_push_heap_stash(c);
    duk_get_prop_string(c, -1, kValues);
    duk_dup(c, -3);
    duk_put_prop_index(c, -2, index);
    duk_pop_3(c);
  }
  duk_uarridx_t TakeIndex() {
    if (free.empty()) return next_index++;
    const duk_uarridx_t index = free.back();
    free.pop_back();
    return index;
  }

  static duk_ret_t Eval(duk_context* c);

  Limits limits;
  duk_context* context = nullptr;
  Engine* owner = nullptr;
  const Chain* current = nullptr;
  std::size_t used = 0;
  std::size_t allowance = 0;
  std::uint64_t steps_left = 0;
  std::chrono::steady_clock::time_point deadline;
  bool starved = false;
  bool out_of_time = false;
  bool ok = false;
  int nesting = 0;
  std::string error_text;
  std::vector<duk_uarridx_t> free;
  duk_uarridx_t next_index = 0;
  duk_size_t cached = 0;

  template <typename Action>
  vm::Result<Value> Make(Action action);
  void Push(duk_context* c, const Value& value) const;
  vm::Result<Value> Call(const Chain& chain, const std::string& body, bool keep,
                         const Value* argument);
};

struct Value::Slot {
  Engine::Impl* impl;
  duk_uarridx_t index;
  Slot(Engine::Impl* owner, duk_uarridx_t at) : impl(owner), index(at) {}
  Slot(const Slot&) = delete;
  Slot& operator=(const Slot&) = delete;
  ~Slot() {
    impl->Protect([this](duk_context* c) {
      duk_push_undefined(c);
      Engine::Impl::StoreTop(c, index);
    });
    impl->free.push_back(index);
  }
};

void Engine::Impl::Push(duk_context* c, const Value& value) const {
  if (value.slot_) {
    PushSlot(c, value.slot_->index);
  } else {
    duk_push_undefined(c);
  }
}

template <typename Action>
vm::Result<Value> Engine::Impl::Make(Action action) {
  const duk_uarridx_t index = TakeIndex();
  const bool done = Protect([&](duk_context* c) {
    action(c);
    StoreTop(c, index);
  });
  if (!done) {
    free.push_back(index);
    return std::unexpected(Failure());
  }
  return Value(std::make_shared<Value::Slot>(this, index));
}

namespace {

/// (function(__s0,..,__v){with(__s0)..{BODY}})
std::string Wrap(std::size_t scopes, const std::string& body) {
  std::string code = "(function(";
  for (std::size_t i = 0; i < scopes; ++i) code += "__s" + std::to_string(i) + ",";
  code += "__v){";
  for (std::size_t i = 0; i < scopes; ++i) code += "with(__s" + std::to_string(i) + ")";
  return code + "{" + body + "}})";
}

}  // namespace

vm::Result<Value> Engine::Impl::Call(const Chain& chain, const std::string& body, bool keep,
                                     const Value* argument) {
  const std::string code = Wrap(chain.size(), body);
  const Chain* outer = std::exchange(current, &chain);
  auto result = Make([&](duk_context* c) {
    duk_push_heap_stash(c);
    duk_get_prop_string(c, -1, kCache);
    if (!duk_get_prop_lstring(c, -1, code.data(), code.size())) {
      duk_pop(c);
      duk_push_lstring(c, code.data(), code.size());
      duk_push_string(c, "script");
      duk_compile(c, DUK_COMPILE_EVAL);
      duk_call(c, 0);
      if (keep && cached < kMaxCached) {
        ++cached;
        duk_dup_top(c);
        duk_put_prop_lstring(c, -3, code.data(), code.size());
      }
    }
    for (const Value& scope : chain) Push(c, scope);
    if (argument) {
      Push(c, *argument);
    } else {
      duk_push_undefined(c);
    }
    duk_call(c, static_cast<duk_idx_t>(chain.size()) + 1);
  });
  current = outer;
  return result;
}

/// eval(code): as an expression of the scopes it is called from, or as a script.
duk_ret_t Engine::Impl::Eval(duk_context* c) {
  Impl& impl = From(c);
  if (!duk_is_string(c, 0)) return 1;
  if (!impl.current || impl.nesting > 8) return duk_error(c, DUK_ERR_EVAL_ERROR, "eval refused");
  bool failed = false;
  {
    const std::string code = duk_get_string(c, 0);
    const Chain chain = *impl.current;
    auto value = impl.owner->Evaluate(chain, code);
    if (!value && value.error().code == vm::Errc::kSyntax) {
      auto ran = impl.owner->Run(chain, code);
      if (ran) value = impl.owner->Undefined();
    }
    failed = !value;
    if (value) impl.Push(c, *value);
  }
  if (failed) return duk_error(c, DUK_ERR_EVAL_ERROR, "%s", impl.error_text.c_str());
  return 1;
}

Engine::Engine(const Limits& limits) : impl_(std::make_unique<Impl>(limits)) {
  impl_->owner = this;
  if (!impl_->ok) {
    std::fprintf(stderr, "script prelude: %s\n", impl_->error_text.c_str());
    std::abort();
  }
}
Engine::~Engine() = default;

vm::Result<Value> Engine::Evaluate(const Chain& chain, const std::string& expression) {
  if (expression.size() > impl_->limits.source_bytes) {
    return vm::Fail(vm::Errc::kLimit,
                    "an expression over " + std::to_string(impl_->limits.source_bytes) + " bytes");
  }
  auto rewritten = Rewrite(expression, SourceKind::kExpression);
  if (!rewritten) return std::unexpected(rewritten.error());
  return impl_->Call(chain, "return (" + rewritten->code + "\n);", true, nullptr);
}

vm::Result<void> Engine::Run(const Chain& chain, const std::string& script) {
  if (script.size() > impl_->limits.source_bytes) {
    return vm::Fail(vm::Errc::kLimit,
                    "a script over " + std::to_string(impl_->limits.source_bytes) + " bytes");
  }
  auto rewritten = Rewrite(script, SourceKind::kScript);
  if (!rewritten) return std::unexpected(rewritten.error());
  if (!chain.empty()) {
    for (const std::string& name : rewritten->declared) {
      if (!Has(chain.back(), name)) Set(chain.back(), name, Undefined());
    }
  }
  auto result = impl_->Call(chain, rewritten->code + "\n", false, nullptr);
  if (!result) return std::unexpected(result.error());
  return {};
}

vm::Result<void> Engine::Assign(const Chain& chain, const std::string& path, const Value& value) {
  auto rewritten = Rewrite(path, SourceKind::kExpression);
  if (!rewritten) return std::unexpected(rewritten.error());
  auto result = impl_->Call(chain, rewritten->code + "\n=__v;", true, &value);
  if (!result) return std::unexpected(result.error());
  return {};
}

// --- making values

Value Engine::NewScope() {
  return impl_->Make([](duk_context* c) { duk_push_bare_object(c); }).value_or(Value());
}
Value Engine::Undefined() {
  return impl_->Make([](duk_context* c) { duk_push_undefined(c); }).value_or(Value());
}
Value Engine::Null() {
  return impl_->Make([](duk_context* c) { duk_push_null(c); }).value_or(Value());
}
Value Engine::String(std::string_view text) {
  auto made = impl_->Make([&](duk_context* c) { duk_push_lstring(c, text.data(), text.size()); });
  return made ? *made : Value();
}
Value Engine::Number(double number) {
  return impl_->Make([&](duk_context* c) { duk_push_number(c, number); }).value_or(Value());
}
Value Engine::Boolean(bool truth) {
  return impl_->Make([&](duk_context* c) { duk_push_boolean(c, truth ? 1 : 0); }).value_or(Value());
}
vm::Result<Value> Engine::Json(const std::string& json) {
  return impl_->Make([&](duk_context* c) {
    duk_push_lstring(c, json.data(), json.size());
    duk_json_decode(c, -1);
  });
}
vm::Result<Value> Engine::Dom(const std::string& json) {
  return impl_->Make([&](duk_context* c) {
    duk_get_global_string(c, "__dom");
    duk_push_lstring(c, json.data(), json.size());
    duk_json_decode(c, -1);
    duk_call(c, 1);
  });
}
Value Engine::Copy(const Value& array) {
  auto made = impl_->Make([&](duk_context* c) {
    impl_->Push(c, array);
    duk_push_string(c, "slice");
    duk_call_prop(c, -2, 0);
  });
  return made ? *made : Array();
}

// --- looking into values

bool Engine::Has(const Value& object, const std::string& name) {
  bool has = false;
  impl_->Protect([&](duk_context* c) {
    impl_->Push(c, object);
    has = duk_is_object(c, -1) && duk_has_prop_lstring(c, -1, name.data(), name.size());
  });
  return has;
}
bool Engine::HasOwnGlobal(const std::string& name) {
  bool has = false;
  impl_->Protect([&](duk_context* c) {
    duk_push_global_object(c);
    duk_push_lstring(c, name.data(), name.size());
    duk_get_prop_desc(c, -2, 0);
    // What the engine brings along is not enumerable.
    has = duk_is_object(c, -1) && duk_get_prop_string(c, -1, "enumerable") != 0 &&
          duk_to_boolean(c, -1) != 0;
  });
  return has;
}
Value Engine::Get(const Value& object, const std::string& name) {
  auto got = impl_->Make([&](duk_context* c) {
    impl_->Push(c, object);
    if (duk_is_null_or_undefined(c, -1)) return duk_push_undefined(c);
    duk_get_prop_lstring(c, -1, name.data(), name.size());
  });
  return got ? *got : Value();
}
void Engine::Set(const Value& object, const std::string& name, const Value& value) {
  impl_->Protect([&](duk_context* c) {
    impl_->Push(c, object);
    impl_->Push(c, value);
    duk_put_prop_lstring(c, -2, name.data(), name.size());
  });
}
void Engine::Remove(const Value& object, const std::string& name) {
  impl_->Protect([&](duk_context* c) {
    impl_->Push(c, object);
    duk_del_prop_lstring(c, -1, name.data(), name.size());
  });
}
void Engine::Freeze(const Value& object) {
  impl_->Protect([&](duk_context* c) {
    impl_->Push(c, object);
    duk_freeze(c, -1);
  });
}
std::vector<std::string> Engine::Keys(const Value& object) {
  std::vector<std::string> keys;
  std::string joined;
  impl_->Protect([&](duk_context* c) {
    duk_get_global_string(c, "__keys");
    impl_->Push(c, object);
    duk_call(c, 1);
    duk_size_t size = 0;
    const char* text = duk_get_lstring(c, -1, &size);
    if (text) joined.assign(text, size);
  });
  for (std::size_t at = 0; at < joined.size();) {
    const std::size_t end = std::min(joined.find('\n', at), joined.size());
    keys.push_back(joined.substr(at, end - at));
    at = end + 1;
  }
  return keys;
}
std::size_t Engine::Length(const Value& array) {
  std::size_t length = 0;
  impl_->Protect([&](duk_context* c) {
    impl_->Push(c, array);
    if (!duk_is_object(c, -1)) return;
    duk_get_prop_string(c, -1, "length");
    length = duk_get_uint_default(c, -1, 0);
  });
  return length;
}

bool Engine::IsUndefined(const Value& value) {
  bool is = true;
  impl_->Protect([&](duk_context* c) {
    impl_->Push(c, value);
    is = duk_is_undefined(c, -1) != 0;
  });
  return is;
}
bool Engine::IsObject(const Value& value) {
  bool is = false;
  impl_->Protect([&](duk_context* c) {
    impl_->Push(c, value);
    is = duk_is_object(c, -1) != 0;
  });
  return is;
}
bool Engine::IsArray(const Value& value) {
  bool is = false;
  impl_->Protect([&](duk_context* c) {
    impl_->Push(c, value);
    is = duk_is_array(c, -1) != 0;
  });
  return is;
}
bool Engine::IsBoolean(const Value& value) {
  bool is = false;
  impl_->Protect([&](duk_context* c) {
    impl_->Push(c, value);
    is = duk_is_boolean(c, -1) != 0;
  });
  return is;
}
bool Engine::IsNumber(const Value& value) {
  bool is = false;
  impl_->Protect([&](duk_context* c) {
    impl_->Push(c, value);
    is = duk_is_number(c, -1) != 0;
  });
  return is;
}
bool Engine::IsString(const Value& value) {
  bool is = false;
  impl_->Protect([&](duk_context* c) {
    impl_->Push(c, value);
    is = duk_is_string(c, -1) != 0;
  });
  return is;
}
bool Engine::ToBoolean(const Value& value) {
  bool truth = false;
  impl_->Protect([&](duk_context* c) {
    impl_->Push(c, value);
    truth = duk_to_boolean(c, -1) != 0;
  });
  return truth;
}
std::string Engine::ToString(const Value& value) {
  std::string text;
  impl_->Protect([&](duk_context* c) {
    impl_->Push(c, value);
    duk_size_t size = 0;
    const char* bytes = duk_safe_to_lstring(c, -1, &size);
    text.assign(bytes, size);
  });
  return text;
}
std::string Engine::ToJson(const Value& value) {
  std::string text = "undefined";
  const bool done = impl_->Protect([&](duk_context* c) {
    duk_get_global_string(c, "__json");
    impl_->Push(c, value);
    duk_call(c, 1);
    duk_size_t size = 0;
    const char* bytes = duk_get_lstring(c, -1, &size);
    if (bytes) text.assign(bytes, size);
  });
  return done ? text : "\"[object]\"";
}

std::size_t Engine::heap_bytes() const { return impl_->used; }

}  // namespace vxml::script
