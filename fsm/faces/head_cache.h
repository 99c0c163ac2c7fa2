#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include "fsm/base/log.h"
#include "fsm/base/table_folder.h"
#include "fsm/rig/head.h"

namespace fsm {

/// A folder that caches baked heads of files, so that the next start need not bake them: for each a
/// .glb (WriteAsset) and a .txt that lists its sources, which are its file, its .points, the files
/// that it names, the tables and this program. A head is baked anew when the size or time of a
/// source has changed. Programs may share a folder; other files in it are not touched. Limit:
/// kMaxHeads; the oldest are deleted first.
class HeadCache {
 public:
  static constexpr std::size_t kMaxHeads = 32;
  /// `folder`: "" = no caching; created when the first head is stored. `log`: takes the notices of
  /// heads and the errors of the cache.
  HeadCache(std::string folder, Log log) : folder_(std::move(folder)), log_(std::move(log)) {}
  /// Returns the head of MakeHeadOfFile, from the cache if possible.
  std::unique_ptr<Head> HeadOfFile(const std::string& path, const TableFolder& tables) const;

 private:
  std::unique_ptr<Head> Find(const std::string& entry, const std::string& sources) const;
  void Notice(const std::string& text) const { log_("notice: " + text); }
  void Keep(const std::string& entry, const std::string& made_from, const Head& head) const;
  void DropOldest() const;

  std::string folder_;
  Log log_;
};

}  // namespace fsm
