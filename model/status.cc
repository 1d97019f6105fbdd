#include "model/status.h"

namespace softland {

std::string_view to_string(Status status) {
  switch (status) {
    case Status::not_run:
      return "not_run";
    case Status::done:
      return "done";
    case Status::open:
      return "open";
    case Status::no_contact:
      return "no_contact";
    case Status::not_settled:
      return "not_settled";
    case Status::collapsed_at_rest:
      return "collapsed_at_rest";
    case Status::collapsed_onto_electrode:
      return "collapsed_onto_electrode";
    case Status::numerical_failure:
      return "numerical_failure";
    case Status::interrupted:
      return "interrupted";
  }
  return "unknown";
}

}  // namespace softland
