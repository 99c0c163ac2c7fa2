#pragma once

#include <memory>
#include <optional>
#include <string>

#include "fsm/base/table_folder.h"
#include "fsm/head/features.h"
#include "fsm/rig/head.h"
#include "fsm/rig/unit_table.h"

namespace fsm {

/// Reads the displacements of units, action_units.txt, from a folder of tables or of a face;
/// nothing if it has none. They replace fsm/head/tables/action_units.txt. Throws std::runtime_error
/// naming file and line.
std::optional<UnitTable> UnitsIn(const TableFolder& folder);
/// Reads the shapes of teeth, ears, lashes and so on, features.txt, from a folder of tables; the
/// built-in ones if it has none. Throws as UnitsIn.
std::shared_ptr<const Features> FeaturesIn(const TableFolder& folder);
/// Returns the head with its units replaced by `units`, if given.
std::unique_ptr<Head> WithUnits(const std::optional<UnitTable>& units, std::unique_ptr<Head> head);
/// Returns the folder whose units apply to the face in `folder`: itself if it has any, else
/// `tables`.
TableFolder UnitsFolder(const std::string& folder, const TableFolder& tables);

/// Makes a built-in head or one from FacesFolder. Its units are those of its own folder, else those
/// of `tables`; its features are those of `tables`. Throws std::runtime_error.
std::unique_ptr<Head> MakeHeadOfName(const std::string& face, const TableFolder& tables = {});

}  // namespace fsm
