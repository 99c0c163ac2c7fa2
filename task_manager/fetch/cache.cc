#include "task_manager/fetch/cache.h"

#include <curl/curl.h>

#include <algorithm>
#include <charconv>

#include "vm_protocol/core/lower_case.h"

namespace vxml::fetch {
namespace {

std::string Header(const vm::HttpAnswer& response, const std::string& name) {
  const auto found = response.head.headers.find(name);
  return found == response.head.headers.end() ? "" : found->second;
}

/// The directive's number in Cache-Control, or -1 where it stands without one.
std::optional<long long> Directive(const std::string& control, std::string_view name) {
  for (std::size_t at = 0; at < control.size();) {
    const std::size_t end = std::min(control.find(',', at), control.size());
    std::string part = vm::LowerCase(control.substr(at, end - at));
    part.erase(0, part.find_first_not_of(" \t"));
    if (part.starts_with(name)) {
      const std::string rest = part.substr(name.size());
      if (rest.empty() || rest[0] == ' ') return -1;
      if (rest[0] == '=') {
        long long value = -1;
        const std::size_t from = rest.find_first_of("0123456789");
        if (from == std::string::npos) return -1;
        std::from_chars(rest.data() + from, rest.data() + rest.size(), value);
        return value;
      }
    }
    at = end + 1;
  }
  return {};
}

long long Number(const std::string& text) {
  long long value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

CacheEntry Describe(const vm::HttpAnswer& response, long long now) {
  CacheEntry entry;
  entry.response = response;
  entry.stored_at = now;
  entry.age_at_store = Number(Header(response, "age"));
  const std::string control = Header(response, "cache-control");
  const auto date = ParseHttpDate(Header(response, "date")).value_or(now);
  if (date < now) entry.age_at_store = std::max(entry.age_at_store, now - date);
  if (const auto age = Directive(control, "max-age"); age && *age >= 0) {
    entry.lifetime = *age;
  } else if (const std::string expires = Header(response, "expires"); !expires.empty()) {
    entry.lifetime = std::max(0LL, ParseHttpDate(expires).value_or(date) - date);
  } else if (const auto changed = ParseHttpDate(Header(response, "last-modified"))) {
    entry.lifetime = std::clamp((date - *changed) / 10, 0LL, 86'400LL);  // the usual guess: 10 %
  }
  if (Directive(control, "no-cache") || Header(response, "pragma") == "no-cache") {
    entry.lifetime = 0;
    entry.must_revalidate = true;
  }
  if (Directive(control, "must-revalidate")) entry.must_revalidate = true;
  return entry;
}

}  // namespace

std::optional<long long> ParseHttpDate(const std::string& text) {
  if (text.empty()) return {};
  const time_t when = curl_getdate(text.c_str(), nullptr);
  if (when == -1) return {};
  return when;
}

bool Usable(const CacheEntry& entry, long long now, std::optional<long long> max_age,
            std::optional<long long> max_stale) {
  const long long age = entry.Age(now);
  if (max_age && age > *max_age) return false;
  const long long stale = age - entry.lifetime;
  if (stale < 0) return true;
  if (entry.must_revalidate || !max_stale) return false;
  return stale <= *max_stale;
}

const CacheEntry* HttpCache::Find(const std::string& uri) {
  const auto found = by_uri_.find(uri);
  if (found == by_uri_.end()) return nullptr;
  items_.splice(items_.begin(), items_, found->second);
  return &found->second->entry;
}

void HttpCache::Store(const std::string& uri, const vm::HttpAnswer& response, long long now) {
  Drop(uri);
  if (Directive(Header(response, "cache-control"), "no-store")) return;
  if (Header(response, "vary") == "*" || response.body.size() > max_bytes_) return;
  items_.push_front({uri, Describe(response, now)});
  by_uri_[uri] = items_.begin();
  bytes_ += response.body.size();
  while (bytes_ > max_bytes_) Drop(std::string(items_.back().uri));
}

const CacheEntry* HttpCache::Refresh(const std::string& uri, const vm::HttpAnswer& not_modified,
                                     long long now) {
  const auto found = by_uri_.find(uri);
  if (found == by_uri_.end()) return nullptr;
  vm::HttpAnswer merged = found->second->entry.response;
  for (const auto& [name, value] : not_modified.head.headers) merged.head.headers[name] = value;
  if (!not_modified.head.headers.contains("age")) merged.head.headers.erase("age");
  found->second->entry = Describe(merged, now);
  return &found->second->entry;
}

void HttpCache::Drop(const std::string& uri) {
  const auto found = by_uri_.find(uri);
  if (found == by_uri_.end()) return;
  bytes_ -= found->second->entry.response.body.size();
  items_.erase(found->second);
  by_uri_.erase(found);
}

}  // namespace vxml::fetch
