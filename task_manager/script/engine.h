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

struct Limits {
  std::size_t heap_bytes = std::size_t{32} << 20;  ///< and more to recover
  std::chrono::milliseconds time{1000};            ///< of the processor, for one evaluation
  std::size_t source_bytes = std::size_t{1} << 20;
  /// Called, from another thread, when a script used up its time but cannot be stopped, since a
  /// single call of the library goes on and on: it may end the process. Null: it is waited for.
  std::function<void()> on_stuck{};
};

/// The data model: ECMAScript 2022 (SpiderMonkey) with scopes that are ordinary objects.
/// Thread: one instance, one thread; those of a thread share its memory limit. Errors: kBadValue
/// (the script threw; the text is the exception's), kSyntax, kLimit (heap, time). After any error
/// the engine goes on working.
class Engine {
 public:
  explicit Engine(const Limits& limits = {});
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  vm::Result<Value> Evaluate(const Chain& chain, const std::string& expression);
  /// Runs statements. `var`s and functions of the top level become properties of the innermost
  /// scope; `let`, `const` and classes live as long as that scope, in it, without being properties.
  vm::Result<void> Run(const Chain& chain, const std::string& script);
  /// `path = value`, where path is a name or a member expression. What does not exist or is
  /// read-only is an error.
  vm::Result<void> Assign(const Chain& chain, const std::string& path, const Value& value);
  /// Whether the text is an expression, or statements. Runs nothing.
  vm::Result<void> CheckExpression(const std::string& expression);
  vm::Result<void> CheckScript(const std::string& script);
  bool IsIdentifier(const std::string& text);  ///< and no reserved word
  /// Whether a script or a scope of the chain has declared that identifier.
  bool IsDeclared(const Chain& chain, const std::string& identifier);

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
  Value Get(const Value& object, const std::string& name);
  void Set(const Value& object, const std::string& name, const Value& value);
  void Freeze(const Value& object);
  std::vector<std::string> Keys(const Value& object);
  std::size_t Length(const Value& array);

  /// Defines a variable that counts in cleared() whenever it becomes undefined. It cannot be
  /// deleted.
  void SetWatched(const Value& scope, const std::string& name, const Value& value);
  std::uint64_t cleared() const;

  bool IsUndefined(const Value& value);
  bool IsObject(const Value& value);
  bool IsArray(const Value& value);
  bool ToBoolean(const Value& value);
  std::string ToString(const Value& value);
  /// The same, where a toString of the script's own may fail.
  vm::Result<std::string> Text(const Value& value);
  /// JSON text; functions and cycles become their string; undefined is "undefined".
  std::string ToJson(const Value& value);
  /// A copy as a shallow array (for iterating while it may change).
  Value Copy(const Value& array);
  /// Makes the property one that scripts can neither change nor remove.
  void SetReadOnly(const Value& object, const std::string& name, const Value& value);
  /// Read-only DOM of an XML document given as prelude.js wants it.
  vm::Result<Value> Dom(const std::string& json);

 private:
  friend class Value;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vxml::script
