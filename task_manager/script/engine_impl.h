#pragma once

// The inside of Engine, for its own sources only: the Duktape heap with its limits.

#include <duktape.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "task_manager/script/engine.h"
#include "task_manager/script/regexps.h"

namespace vxml::script {

constexpr duk_size_t kMaxCached = 2000;
constexpr const char* kValues = "v";
constexpr const char* kCache = "c";
constexpr const char* kText = "t";  // the text last searched by a regular expression
constexpr std::size_t kLargeBlock = std::size_t{64} << 10;

struct BlockHeader {
  std::size_t size;
  std::size_t pad;  // keeps the block behind it aligned
};

struct Engine::Impl {
  explicit Impl(const Limits& given);
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
    // Large blocks are what long operations on texts are made of, and nobody counts those.
    if (size > had && size > kLargeBlock && impl.nesting > 0 && impl.Late()) {
      impl.out_of_time = true;
      impl.steps_left = 0;
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
  /// Whether the evaluation has used up its time. Real time is cheap to ask for; only when that is
  /// over is the thread's own time looked at from then on, so that a busy machine does not count
  /// against a script, and the many short evaluations do not ask the system.
  bool Late() {
    const auto now = limits.clocks.real();
    if (now <= deadline) return false;
    if (!measured) {
      measured = true;
      began = limits.clocks.processor();
      deadline = now + limits.time;
      return false;
    }
    const auto spent = limits.clocks.processor() - began;
    if (spent >= limits.time) return true;
    deadline = now + (limits.time - spent);
    return false;
  }
  static duk_ret_t Tick(duk_context* c) {
    Impl& impl = From(c);
    // Functions of the engine that go over many elements charge for all of them at once.
    const double asked = duk_get_number_default(c, 0, 1);
    const std::uint64_t cost = asked > 1 ? static_cast<std::uint64_t>(std::min(asked, 1e15)) : 1;
    if (impl.steps_left < cost || impl.Late()) return impl.RunOut(c);
    impl.steps_left -= cost;
    duk_push_true(c);
    return 1;
  }
  duk_ret_t RunOut(duk_context* c) {
    steps_left = 0;
    out_of_time = true;
    return duk_error(c, DUK_ERR_RANGE_ERROR, "the script runs too long");
  }
  void StartBudget() {
    if (nesting > 0) return;
    steps_left = limits.steps;
    measured = false;
    deadline = limits.clocks.real() + limits.time;
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
  static duk_ret_t MatchPattern(duk_context* c);

  Limits limits;
  duk_context* context = nullptr;
  Engine* owner = nullptr;
  const Chain* current = nullptr;
  std::size_t used = 0;
  std::size_t allowance = 0;
  std::uint64_t steps_left = 0;
  bool measured = false;
  std::chrono::nanoseconds began{};
  std::chrono::nanoseconds deadline{};
  Regexps regexps;
  std::u32string searched;  // kText's characters
  const void* searched_in = nullptr;
  Regexps::Spans spans;  // here, because an error of the engine jumps over destructors
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

}  // namespace vxml::script
