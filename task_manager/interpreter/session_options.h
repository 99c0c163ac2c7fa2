#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "task_manager/fetch/fetcher.h"
#include "task_manager/platform/json_line.h"
#include "task_manager/script/engine.h"

namespace vxml {

struct SessionOptions {
  std::string uri;
  fetch::Options fetch{};
  script::Limits script{};
  std::map<std::string, std::string> properties{};          ///< platform defaults to change
  std::map<std::string, std::string> session_variables{};   ///< "connection.remote.uri" -> value
  std::size_t max_steps_between_inputs = 100'000;           ///< elements and items executed
  std::chrono::milliseconds max_time_between_inputs{2500};  ///< of the processor
  std::size_t max_subdialogs = 40;                          ///< one inside the other
  bool strict_markup = false;  ///< unknown emotions are error.unsupported.emotion
  /// Languages (en, ja-JP, ...) there is a voice and an ear for; empty = every language there is.
  std::vector<std::string> languages{};
  /// Explains what the interpreter does; null = nobody wants to know.
  std::function<void(std::string_view kind, const JsonLine& fields)> trace{};
};

}  // namespace vxml
