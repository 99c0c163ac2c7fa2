#include "task_manager/interpreter/document_set.h"

#include <charconv>
#include <functional>

#include "task_manager/document/schema.h"
#include "task_manager/document/values.h"

namespace vxml {

using script::Value;

fetch::Request DocumentSet::RequestFor(const vm::xml::Node& node, const char* kind) const {
  fetch::Request request;
  request.from = rt_.position.OriginOf(node).uri;
  const auto text_of = [&](const char* attribute, const std::string& property) {
    const std::string text = node.Get(attribute);
    return text.empty() ? rt_.properties.Get(property, &node) : text;
  };
  const auto seconds = [&](const char* name) -> std::optional<long long> {
    std::string text = text_of(name, std::string(kind) + name);
    if (text.ends_with("s")) text.pop_back();
    long long value = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    if (read.ec != std::errc()) return {};
    return value;
  };
  request.max_age = seconds("maxage");
  request.max_stale = seconds("maxstale");
  request.timeout = ParseTime(text_of("fetchtimeout", "fetchtimeout"));
  return request;
}

void DocumentSet::TraceFetch(const std::string& uri, const char* kind,
                             const std::expected<fetch::Response, fetch::Failure>& got) const {
  JsonLine line;
  line.Text("uri", uri).Text("kind", kind).Bool("ok", got.has_value());
  if (got) line.Bool("cached", got->from_cache);
  if (!got) line.Text("error", got.error().text);
  rt_.Trace("fetch", line);
}

std::expected<fetch::Response, fetch::Failure> DocumentSet::FetchSilently(
    const fetch::Request& request, const char* kind) {
  auto got = fetcher_.Fetch(request);
  TraceFetch(request.uri, kind, got);
  return got;
}

fetch::Response DocumentSet::Fetch(const vm::xml::Node& node, const fetch::Request& request,
                                   const char* kind) {
  std::string audio = node.Get("fetchaudio");
  if (audio.empty()) audio = rt_.properties.Get("fetchaudio", &node);
  const bool plays = !audio.empty() && rt_.connection.is_open();
  if (plays) queue_.Flush();  // fetchaudio: what is queued is heard while fetching
  const bool slow =
      request.uri.starts_with("http") && !rt_.properties.Is("attention", "false", &node);
  if (slow || plays) {
    rt_.platform.Fetching(plays ? fetch::Resolve(rt_.position.BaseOf(node), audio) : "", true);
  }
  auto got = FetchSilently(request, kind);
  if (slow || plays) rt_.platform.Fetching("", false);
  if (got) return std::move(*got);
  const fetch::Failure& failure = got.error();
  std::string event = "error.badfetch";
  if (failure.http_status > 0) event += ".http." + std::to_string(failure.http_status);
  if (failure.code == vm::Errc::kAccess) event = "error.noauthorization";
  ThrowEvent(event, failure.text);
}

std::shared_ptr<VxmlDocument> DocumentSet::Load(const vm::xml::Node& node,
                                                const fetch::Request& request) {
  const fetch::Response got = Fetch(node, request, "document");
  const std::string uri = fetch::WithoutFragment(got.uri);
  // The same bytes of the same place are parsed once: long sessions do not grow by going round.
  const std::size_t hash = std::hash<std::string>()(got.body);
  for (const auto& [key, document] : parsed_) {
    if (key.first == uri && key.second == hash) return document;
  }
  auto document = LoadDocument(got.body, uri, got.charset);
  if (!document) ThrowEvent("error.badfetch", document.error().text);
  parsed_.push_back({{uri, hash}, *document});
  return *document;
}

bool DocumentSet::IsRoot(const std::string& uri) const {
  const auto& root = rt_.position.root;
  return root && root->uri == uri && root->root->IsElement("vxml");
}

std::shared_ptr<VxmlDocument> DocumentSet::LoadRoot(const vm::xml::Node& node,
                                                    const VxmlDocument& document) {
  if (!fetch::MayRead(document.uri, document.application)) {  // nor share a root that is here
    ThrowEvent("error.noauthorization",
               document.uri + ": its application root " + document.application + " is a file");
  }
  if (IsRoot(document.application)) return rt_.position.root;
  fetch::Request request = RequestFor(node, "document");
  request.uri = document.application;
  auto root = Load(node, request);
  if (!root->application.empty()) {
    ThrowEvent("error.semantic",
               document.application + ": an application root with a root of its own");
  }
  return root;
}

/// The transition to the dialog that the URI's fragment names, or to the first.
Transition DocumentSet::At(Transition to, const std::string& uri) const {
  const std::string fragment = fetch::Fragment(uri);
  if (!fragment.empty()) {
    to.dialog = to.document->FindDialog(fragment);
    if (!to.dialog) ThrowEvent("error.badfetch", uri + ": there is no dialog '" + fragment + "'");
  } else if (!to.document->dialogs.empty()) {
    to.dialog = to.document->dialogs.front();
  }
  return to;
}

Transition DocumentSet::Locate(const vm::xml::Node& node, const std::string& reference) {
  if (!reference.starts_with("#")) return Submit(node, reference, {}, false);
  Transition to;
  to.document = rt_.position.document;
  to.root = rt_.position.root;
  to.same_document = true;
  return At(std::move(to), fetch::Resolve(rt_.position.BaseOf(node), reference));
}

Transition DocumentSet::Submit(const vm::xml::Node& node, const std::string& reference,
                               Submission submission, bool is_submit) {
  if (reference.starts_with("#") && !is_submit) return Locate(node, reference);
  fetch::Request request = RequestFor(node, "document");
  request.uri = fetch::Resolve(rt_.position.BaseOf(node), reference);
  request.fields = std::move(submission.fields);
  request.post = submission.post;
  request.multipart = submission.multipart;
  Transition to;
  to.document = Load(node, request);
  to.root = to.document->application.empty() ? to.document : LoadRoot(node, *to.document);
  if (to.root == to.document && IsRoot(to.document->uri)) {
    to.fresh_application = is_submit || fetch::HasQuery(request.uri);
  }
  return At(std::move(to), request.uri);
}

std::vector<fetch::Field> DocumentSet::FieldsOf(const vm::xml::Node& node,
                                                const std::string& namelist) {
  std::vector<fetch::Field> fields;
  for (const std::string_view word : SplitWords(namelist)) {
    const std::string name(word);
    AddFields(name, rt_.scopes.Evaluate(node, name), fields, 0);
  }
  return fields;
}

void DocumentSet::AddFields(const std::string& name, const Value& value,
                            std::vector<fetch::Field>& fields, int depth) {
  script::Engine& engine = rt_.engine;
  if (depth > 8 || fields.size() > 10'000) return;
  if (IsRecording(engine, value)) {
    // A recording: its bytes where the platform keeps them, else only its name.
    const auto bytes = rt_.platform.Recording(engine.ToString(engine.Get(value, "uri")));
    fields.push_back(
        {name, bytes ? *bytes : "", engine.ToString(engine.Get(value, "type")), name + ".wav"});
  } else if (engine.IsObject(value)) {
    for (const std::string& key : engine.Keys(value)) {
      AddFields(name + "." + key, engine.Get(value, key), fields, depth + 1);
    }
  } else if (!engine.IsUndefined(value) || depth == 0) {
    fields.push_back({name, engine.IsUndefined(value) ? "" : engine.ToString(value), "", ""});
  }
}

}  // namespace vxml
