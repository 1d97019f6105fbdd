// The outcome of a simulation or other numerical computation. A numerical failure is a status, never an exception.
#pragma once

#include <string_view>

namespace softland {

enum class Status {
  not_run,
  done,
  open,                      ///< the switch stayed open without contact, and the drives were not meant to close it
  no_contact,                ///< the contact point never reached the contact plane in the simulated time
  not_settled,               ///< the run ended during a rebound, or too soon after contact to count as settled
  collapsed_at_rest,         ///< no stable static equilibrium exists from which a run can start
  collapsed_onto_electrode,  ///< the beam reached the metal of an electrode, or a wall on the far side
  numerical_failure,
  interrupted,
};

[[nodiscard]] std::string_view to_string(Status status);

}  // namespace softland
