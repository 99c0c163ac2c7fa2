#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vm_protocol/core/result.h"

namespace vxml::script {

class Engine;

/// A value of the script language, kept alive by this handle. Copies share the value.
/// Lifetime: must not outlive its Engine.
class Value {
 public:
  Value() = default;
  bool valid() const { return slot_ != nullptr; }

 private:
  friend class Engine;
  struct Slot;
  explicit Value(std::shared_ptr<Slot> slot) : slot_(std::move(slot)) {}
  std::shared_ptr<Slot> slot_;
};

/// Scope objects from the outermost to the innermost one.
using Chain = std::vector<Value>;

/// What the time of scripts is measured on, since a moment that does not matter. Each is asked at
/// every loop turn, call and large block of memory. Empty: the machine's.
struct Clocks {
  std::function<std::chrono::nanoseconds()> real{};
  std::function<std::chrono::nanoseconds()> processor{};  ///< of this thread
};

struct Limits {
  std::size_t heap_bytes = std::size_t{32} << 20;  ///< and up to a quarter more to recover
  std::uint64_t steps = 20'000'000;      ///< loop turns and function calls of one evaluation
  std::chrono::milliseconds time{1000};  ///< real time, then as much again of the processor's
  std::size_t source_bytes = std::size_t{1} << 20;
  Clocks clocks{};
};

/// The data model: ECMAScript (Duktape) with scopes that are ordinary objects on a `with` chain.
/// Thread: one instance, one thread. Errors: kBadValue (the script threw; the text is the
/// exception's), kSyntax, kLimit (heap, steps, time). After any error the engine goes on working.
class Engine {
 public:
  explicit Engine(const Limits& limits = {});
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  vm::Result<Value> Evaluate(const Chain& chain, const std::string& expression);
  /// Runs statements; `var`s and functions of the top level go to the innermost scope.
  vm::Result<void> Run(const Chain& chain, const std::string& script);
  /// `path = value`, where path is a name or a member expression. REQUIRES: its base exists.
  vm::Result<void> Assign(const Chain& chain, const std::string& path, const Value& value);

  Value NewScope();  ///< an object without prototype
  Value Undefined();
  Value Null();
  Value String(std::string_view text);
  Value Number(double number);
  Value Boolean(bool truth);
  vm::Result<Value> Json(const std::string& json);
  Value Object() { return Json("{}").value_or(Value()); }
  Value Array() { return Json("[]").value_or(Value()); }

  bool Has(const Value& object, const std::string& name);
  /// A name some script assigned to without declaring it (ECMA-262 makes it global).
  bool HasOwnGlobal(const std::string& name);
  Value Get(const Value& object, const std::string& name);
  void Set(const Value& object, const std::string& name, const Value& value);
  void Remove(const Value& object, const std::string& name);
  void Freeze(const Value& object);
  std::vector<std::string> Keys(const Value& object);
  std::size_t Length(const Value& array);

  bool IsUndefined(const Value& value);
  bool IsObject(const Value& value);
  bool IsArray(const Value& value);
  bool IsBoolean(const Value& value);
  bool IsNumber(const Value& value);
  bool IsString(const Value& value);
  bool ToBoolean(const Value& value);
  std::string ToString(const Value& value);
  /// JSON text; functions and cycles become their string; undefined is "undefined".
  std::string ToJson(const Value& value);
  /// A copy as a shallow array (for iterating while it may change).
  Value Copy(const Value& array);
  /// Read-only DOM of an XML document given as prelude.js wants it.
  vm::Result<Value> Dom(const std::string& json);

  std::size_t heap_bytes() const;

 private:
  friend class Value;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vxml::script
