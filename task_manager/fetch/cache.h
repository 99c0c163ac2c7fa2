#pragma once

#include <list>
#include <map>
#include <optional>
#include <string>

#include "vm_protocol/http/http_caller.h"

namespace vxml::fetch {

/// A stored answer and what is known of its age (RFC 9111). Times are seconds since the epoch.
struct CacheEntry {
  vm::HttpAnswer response;
  long long stored_at = 0;
  long long age_at_store = 0;
  long long lifetime = 0;  ///< how long it is fresh
  bool must_revalidate = false;

  long long Age(long long now) const { return age_at_store + (now - stored_at); }
};

/// Answers to GET by URI, the longest unused ones dropped over `max_bytes`. Pure. One thread.
class HttpCache {
 public:
  explicit HttpCache(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  const CacheEntry* Find(const std::string& uri);
  void Store(const std::string& uri, const vm::HttpAnswer& response, long long now);
  /// A 304 came: the stored answer is fresh again.
  const CacheEntry* Refresh(const std::string& uri, const vm::HttpAnswer& not_modified,
                            long long now);
  void Drop(const std::string& uri);

 private:
  struct Item {
    std::string uri;
    CacheEntry entry;
  };
  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::list<Item> items_;  // most recently used first
  std::map<std::string, std::list<Item>::iterator> by_uri_;
};

/// Whether a stored answer may be used without asking, by VoiceXML 2.0 section 6.1.2: its age is
/// within max_age, and it is fresh or stale by no more than max_stale.
bool Usable(const CacheEntry& entry, long long now, std::optional<long long> max_age,
            std::optional<long long> max_stale);

/// "Sun, 06 Nov 1994 08:49:37 GMT" as seconds since the epoch.
std::optional<long long> ParseHttpDate(const std::string& text);

}  // namespace vxml::fetch
