#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "task_manager/fetch/fetcher.h"
#include "task_manager/interpreter/prompt_queue.h"
#include "task_manager/interpreter/runtime.h"

namespace vxml {

/// What <submit>, <subdialog> and <data> send with their request.
struct Submission {
  std::vector<fetch::Field> fields;
  bool post = false;
  bool multipart = false;
};

/// The documents a session has loaded, and everything else it fetches. Failures are thrown as
/// error.badfetch (with the HTTP status) or error.noauthorization. Thread: the session's.
class DocumentSet {
 public:
  DocumentSet(Runtime& runtime, PromptQueue& queue)
      : rt_(runtime), queue_(queue), fetcher_(runtime.options.fetch) {}

  /// True if no document was ever loaded.
  bool empty() const { return parsed_.empty(); }

  /// Where a reference leads. Loads what has to be loaded, so that a failure is the referrer's.
  Transition Locate(const vm::xml::Node& node, const std::string& reference);
  /// The same with a request of its own: a <submit> loads even the document it stands in.
  Transition Submit(const vm::xml::Node& node, const std::string& reference, Submission submission,
                    bool is_submit);

  /// maxage, maxstale and fetchtimeout of the element, or of the properties for its kind of fetch
  /// (document, grammar, script, data, audio).
  fetch::Request RequestFor(const vm::xml::Node& node, const char* kind) const;
  /// Fetches; what is queued is heard meanwhile if the element or property fetchaudio says so.
  fetch::Response Fetch(const vm::xml::Node& node, const fetch::Request& request, const char* kind);
  /// Fetches without a word: grammars that others refer to, sound.
  std::expected<fetch::Response, fetch::Failure> FetchSilently(const fetch::Request& request,
                                                               const char* kind);
  /// The variables of the namelist as fields; objects property by property, as a.b=value, and
  /// recordings as their bytes.
  std::vector<fetch::Field> FieldsOf(const vm::xml::Node& node, const std::string& namelist);

 private:
  std::shared_ptr<VxmlDocument> Load(const vm::xml::Node& node, const fetch::Request& request);
  std::shared_ptr<VxmlDocument> LoadRoot(const vm::xml::Node& node, const VxmlDocument& document);
  /// True if an application root is loaded and is the one of that URI.
  bool IsRoot(const std::string& uri) const;
  Transition At(Transition to, const std::string& uri) const;
  void AddFields(const std::string& name, const script::Value& value,
                 std::vector<fetch::Field>& fields, int depth);
  void TraceFetch(const std::string& uri, const char* kind,
                  const std::expected<fetch::Response, fetch::Failure>& got) const;

  Runtime& rt_;
  PromptQueue& queue_;
  fetch::Fetcher fetcher_;
  /// By URI and hash of the bytes; kept, since compiled grammars name their nodes.
  std::vector<std::pair<std::pair<std::string, std::size_t>, std::shared_ptr<VxmlDocument>>>
      parsed_;
};

}  // namespace vxml
