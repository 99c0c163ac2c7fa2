#include "task_manager/script/engine.h"

#include <ctime>

#include "embedded/prelude.h"
#include "embedded/regexps.h"
#include "task_manager/script/engine_impl.h"
#include "task_manager/script/rewriter.h"

namespace vxml::script {

namespace {

std::chrono::nanoseconds RealTime() { return std::chrono::steady_clock::now().time_since_epoch(); }

std::chrono::nanoseconds ThreadTime() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

}  // namespace

Engine::Impl::Impl(const Limits& given) : limits(given) {
  if (!limits.clocks.real) limits.clocks.real = RealTime;
  if (!limits.clocks.processor) limits.clocks.processor = ThreadTime;
  context = duk_create_heap(&Allocate, &Reallocate, &Release, this, &Fatal);
  if (!context) std::abort();
  Protect([](duk_context* c) {
    duk_push_heap_stash(c);
    duk_push_array(c);
    duk_put_prop_string(c, -2, kValues);
    duk_push_object(c);
    duk_put_prop_string(c, -2, kCache);
    duk_push_c_function(c, &Tick, 1);
    duk_put_global_string(c, "__t");
    duk_push_c_function(c, &Eval, 1);
    duk_put_global_string(c, "__eval");
    duk_push_c_function(c, &MatchPattern, 4);
    duk_put_global_string(c, "__match");
  });
  ok = true;
  for (const std::string_view source : {embedded::prelude(), embedded::regexps()}) {
    ok = ok && Protect([&](duk_context* c) { duk_eval_lstring(c, source.data(), source.size()); });
  }
}

/// __match(source, flags, text, from): beginnings and ends, or null.
duk_ret_t Engine::Impl::MatchPattern(duk_context* c) {
  Impl& impl = From(c);
  if (impl.steps_left == 0 || impl.Late()) return impl.RunOut(c);
  duk_size_t source_size = 0;
  duk_size_t flags_size = 0;
  duk_size_t text_size = 0;
  const char* source = duk_require_lstring(c, 0, &source_size);
  const char* flags = duk_require_lstring(c, 1, &flags_size);
  const char* text = duk_require_lstring(c, 2, &text_size);
  const double from = duk_require_number(c, 3);
  if (text_size > Regexps::kMaxTextBytes) {
    return duk_error(c, DUK_ERR_RANGE_ERROR, "the text is too long for a regular expression");
  }
  // One text is mostly searched many times over: it is kept, alive and in characters.
  if (impl.searched_in != duk_get_heapptr(c, 2)) {
    duk_push_heap_stash(c);
    duk_dup(c, 2);
    duk_put_prop_string(c, -2, kText);
    duk_pop(c);
    impl.searched = Characters({text, text_size});
    impl.searched_in = duk_get_heapptr(c, 2);
  }
  Regexps::Outcome outcome = Regexps::Outcome::kNoMatch;
  if (from >= 0 && from <= static_cast<double>(impl.searched.size())) {
    outcome = impl.regexps.Match({source, source_size}, {flags, flags_size}, impl.searched,
                                 static_cast<std::size_t>(from), impl.spans);
  }
  if (outcome == Regexps::Outcome::kOverLimit || impl.Late()) return impl.RunOut(c);
  if (outcome == Regexps::Outcome::kRefused) {
    return duk_error(c, DUK_ERR_RANGE_ERROR, "the regular expression is too large");
  }
  if (outcome == Regexps::Outcome::kNoMatch) {
    duk_push_null(c);
    return 1;
  }
  const duk_idx_t result = duk_push_array(c);
  for (std::size_t i = 0; i < impl.spans.size(); ++i) {
    duk_push_number(c, static_cast<double>(impl.spans[i]));
    duk_put_prop_index(c, result, static_cast<duk_uarridx_t>(i));
  }
  return 1;
}

void Engine::Impl::Push(duk_context* c, const Value& value) const {
  if (value.slot_) {
    PushSlot(c, value.slot_->index);
  } else {
    duk_push_undefined(c);
  }
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

}  // namespace vxml::script
