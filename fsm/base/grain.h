#pragma once

namespace fsm {

/// A fixed pseudo-random number in -1..1 for a lattice point: the same on every machine.
float Grain(int i, int j);

}  // namespace fsm
