#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include "fsm/base/table_folder.h"
#include "fsm/rig/head.h"

namespace fsm {

/// A folder that keeps heads of files as they were baked, so that the next start need not bake
/// them: of each a .glb (WriteAsset) and a .txt with what it was made from. A head is baked anew
/// when that has another size or time: its file, its .points, the files it names, the tables, this
/// program.
/// Programs may share a folder; whatever else lies in it is left alone. Limit: kMostHeads, the
/// oldest go first.
class HeadCache {
 public:
  static constexpr std::size_t kMostHeads = 32;
  /// "": nothing is kept. The folder is made when something is.
  explicit HeadCache(std::string folder) : folder_(std::move(folder)) {}
  /// The head of MakeHeadOfFile, kept or made by it. Trouble with what is kept is a notice on
  /// stderr.
  std::unique_ptr<Head> HeadOfFile(const std::string& path, const TableFolder& tables) const;

 private:
  static std::unique_ptr<Head> Find(const std::string& entry, const std::string& sources);
  void Keep(const std::string& entry, const std::string& made_from, const Head& head) const;
  void DropOldest() const;

  std::string folder_;
};

}  // namespace fsm
