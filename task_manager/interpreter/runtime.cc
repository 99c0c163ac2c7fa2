#include "task_manager/interpreter/runtime.h"

#include "task_manager/interpreter/languages.h"

namespace vxml {

using script::Value;

Runtime::Runtime(SessionOptions given, Platform& its_platform)
    : options(std::move(given)),
      platform(its_platform),
      engine(options.script),
      budget(options.max_steps_between_inputs, options.max_time_between_inputs),
      properties(position, options.properties),
      scopes(engine, position, budget) {}

void Runtime::Trace(std::string_view kind, const JsonLine& fields) const {
  if (options.trace) options.trace(kind, fields);
}

void Runtime::Warn(const std::string& text, std::size_t line) const {
  JsonLine fields;
  fields.Text("text", text).Number("line", static_cast<double>(line));
  Trace("warning", fields);
}

void Runtime::RequireLanguage(const std::string& language) const {
  if (language.empty() || IsSupported(language, options.languages)) return;
  ThrowEvent("error.unsupported.language", "the language '" + language + "'");
}

Value Runtime::ArrayOf(const vm::xml::Node& foreach) {
  const Value array = scopes.Evaluate(foreach, foreach.Get("array"));
  if (!engine.IsArray(array)) {
    position.ThrowSemantic(foreach, "'" + foreach.Get("array") + "' is not an array");
  }
  if (engine.Length(array) > options.max_steps_between_inputs) {
    ThrowEvent("error.noresource",
               "<foreach> over " + std::to_string(engine.Length(array)) + " elements");
  }
  return engine.Copy(array);
}

Value MakeRecording(script::Engine& engine, const std::string& uri, const std::string& type,
                    Millis duration) {
  const Value recording = engine.Object();
  engine.Set(recording, "uri", engine.String(uri));
  engine.Set(recording, "type", engine.String(type));
  engine.Set(recording, "duration", engine.Number(static_cast<double>(duration.count())));
  return recording;
}

bool IsRecording(script::Engine& engine, const Value& value) {
  return engine.Has(value, "uri") && engine.Has(value, "duration") && engine.Has(value, "type");
}

}  // namespace vxml
