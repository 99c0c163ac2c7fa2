#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "task_manager/document/vxml_document.h"
#include "task_manager/script/engine.h"

namespace vxml {

// What executable content can do besides going on is thrown as one of these C++ objects: a
// VoiceXML <throw> is a C++ throw, caught by the form interpretation algorithm. None of them
// leaves DialogSession::Run().

/// A VoiceXML event on its way to a handler.
struct EventThrown {
  std::string name;
  std::string message;
  bool has_message = false;
};
[[noreturn]] inline void ThrowEvent(std::string name, std::string message = "") {
  const bool has = !message.empty();
  throw EventThrown{std::move(name), std::move(message), has};
}

/// <goto nextitem>.
struct GoToItem {
  std::string name;
};

/// What a recognised input fills, carried into another dialog.
struct Match {
  enum class Owner { kItem, kForm, kLink, kChoice, kUniversal };
  Owner owner = Owner::kForm;
  const vm::xml::Node* node = nullptr;  ///< the form, link, choice or item the grammar belongs to
  const VxmlDocument* document = nullptr;  ///< where that is
  script::Value value;
  std::string utterance;
  double confidence = 1.0;
  bool dtmf = false;
};

using NamedValues = std::vector<std::pair<std::string, script::Value>>;

/// On to a dialog of the same or another document; everything is loaded already.
struct Transition {
  std::shared_ptr<VxmlDocument> document;
  std::shared_ptr<VxmlDocument> root;  ///< equal to document if it is its own root
  const vm::xml::Node* dialog = nullptr;
  bool same_document = false;      ///< the document's variables stay
  bool fresh_application = false;  ///< a submit to the root document starts it anew
  std::shared_ptr<Match> carried;
  NamedValues parameters;  ///< of a <subdialog>, for the variables of its form
};

/// <exit>, a hang-up's end, a failure nobody handled.
struct ExitSession {
  std::string reason;
  std::string value_json = "undefined";
};

/// <return>: values by name, or an event for the caller.
struct ReturnToCaller {
  NamedValues values;
  bool is_event = false;
  EventThrown event;
};

}  // namespace vxml
