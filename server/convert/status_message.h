// Failures on the wire: a status code, a sentence, and google.rpc details a program can read.
#pragma once

#include <grpcpp/support/status.h>

#include <string>
#include <vector>

#include "server/convert/violations.h"
#include "sim/base/error.h"

namespace sunfleck {

// Always carries ErrorInfo{reason, domain "sunfleck"}.
struct Failure {
  grpc::StatusCode code = grpc::StatusCode::INTERNAL;
  std::string reason;                      // "SCENE_UNKNOWN"
  std::string message;                     // a sentence for a person
  std::vector<Violation> violations = {};  // BadRequest
  std::string quota = {};                  // QuotaFailure: which limit
  double retry_after_s = 0;                // RetryInfo where > 0: only when waiting helps
  std::string incident = {};               // id that is in the log
};
grpc::Status status_of(const Failure& failure);

// The other way, for clients: one Error whose sentence lists all violations.
Error error_of(const grpc::Status& status);

}  // namespace sunfleck
