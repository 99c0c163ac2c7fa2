#include "fsm/head/built_in_units.h"

#include "embedded/action_units.h"

namespace fsm {

const ActionUnits& BuiltInUnits() {
  static const ActionUnits units(Table("tables/action_units.txt", embedded::action_units()));
  return units;
}

}  // namespace fsm
