#include "task_manager/script/engine_impl.h"

namespace vxml::script {

// --- making values

Value Engine::NewScope() {
  return impl_
      ->Make([](duk_context* c) {
        const duk_idx_t scope = duk_push_bare_object(c);
        // A script that could give these another meaning would no longer be counted.
        for (const char* name : {"__t", "__f", "__w"}) {
          duk_push_string(c, name);
          duk_get_global_string(c, name);
          duk_def_prop(c, scope,
                       DUK_DEFPROP_HAVE_VALUE | DUK_DEFPROP_HAVE_WRITABLE |
                           DUK_DEFPROP_HAVE_ENUMERABLE | DUK_DEFPROP_HAVE_CONFIGURABLE);
        }
      })
      .value_or(Value());
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
  return ToUtf8(text);
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
  return done ? ToUtf8(text) : "\"[object]\"";
}

std::size_t Engine::heap_bytes() const { return impl_->used; }

}  // namespace vxml::script
