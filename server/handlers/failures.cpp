// Head comment in failures.h.
#include "server/handlers/failures.h"

#include <spdlog/spdlog.h>

#include <atomic>
#include <new>
#include <random>

#include "server/convert/status_message.h"
#include "server/convert/violations.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

using grpc::StatusCode;

// 64 bits that no client can guess and no two incidents share in practice.
std::string new_incident() {
  std::random_device entropy;
  char text[24];
  std::snprintf(text, sizeof text, "%08x%08x", entropy(), entropy());
  return text;
}

grpc::Status internal(ServerState& state, const char* method, const char* what) {
  const std::string incident = new_incident();
  state.log->error("incident={} method={} what=\"{}\"", incident, method, what);
  return status_of({.code = StatusCode::INTERNAL,
                    .reason = "INTERNAL",
                    .message = "the server failed; its log has more under incident " + incident,
                    .incident = incident});
}

std::string problem_and_remedy(const Error& error) {
  return error.remedy().empty() ? error.problem() : error.problem() + " (" + error.remedy() + ")";
}

// A file of the server that is wrong is our fault, not the client's, and its path is nobody's business.
bool tells_a_path(const Error& error) {
  const std::string what = error.what();
  return error.where().find('/') != std::string::npos || what.find(" /") != std::string::npos ||
         what.find("'/") != std::string::npos || what.find("\"/") != std::string::npos;
}

grpc::Status of_error(ServerState& state, const char* method, StopReason stopped, const Error& error) {
  if (error.kind() != ErrorKind::kCancelled && tells_a_path(error))
    return internal(state, method, error.what());
  switch (error.kind()) {
    case ErrorKind::kInvalidInput:
      return status_of({.code = StatusCode::INVALID_ARGUMENT,
                        .reason = "REQUEST_INVALID",
                        .message = error.what(),
                        .violations = {{error.where(), problem_and_remedy(error)}}});
    case ErrorKind::kLimitExceeded:
      return status_of({.code = StatusCode::RESOURCE_EXHAUSTED,
                        .reason = "LIMIT_EXCEEDED",
                        .message = error.what(),
                        .quota = error.where()});
    case ErrorKind::kCancelled:
      return status_of_stop(stopped);
    case ErrorKind::kNotFound:  // a file of the server; unknown scenes have their own exception
    case ErrorKind::kInputOutput:
      break;
  }
  return internal(state, method, error.what());
}

}  // namespace

grpc::Status status_of_exception(ServerState& state, const char* method, StopReason stopped) {
  try {
    throw;
  } catch (const InvalidRequest& invalid) {
    return status_of({.code = StatusCode::INVALID_ARGUMENT,
                      .reason = "REQUEST_INVALID",
                      .message = invalid.what(),
                      .violations = invalid.violations()});
  } catch (const UnknownScene& error) {
    return status_of({.code = StatusCode::NOT_FOUND, .reason = "SCENE_UNKNOWN", .message = error.what()});
  } catch (const Error& error) {
    return of_error(state, method, stopped, error);
  } catch (const std::bad_alloc&) {
    state.log->error("method={} what=\"out of memory\"", method);
    return status_of({.code = StatusCode::RESOURCE_EXHAUSTED,
                      .reason = "OUT_OF_MEMORY",
                      .message = "the server has not enough memory for this call",
                      .quota = "memory"});
  } catch (const std::exception& error) {
    return internal(state, method, error.what());
  } catch (...) {
    return internal(state, method, "unknown exception");
  }
}

grpc::Status status_of_stop(StopReason reason) {
  switch (reason) {
    case StopReason::kDeadline:
      return status_of({.code = StatusCode::DEADLINE_EXCEEDED,
                        .reason = "DEADLINE_EXCEEDED",
                        .message = "the deadline passed before the answer was there"});
    case StopReason::kStalled:
      return status_of({.code = StatusCode::ABORTED,
                        .reason = "READER_STALLED",
                        .message = "the reader of the stream took nothing for too long"});
    case StopReason::kDrain:
      return status_of(
          {.code = StatusCode::UNAVAILABLE, .reason = "DRAINING", .message = "the server shuts down"});
    case StopReason::kClient:
    case StopReason::kNone:
      break;
  }
  return status_of({.code = StatusCode::CANCELLED, .reason = "CANCELLED", .message = "stopped on request"});
}

grpc::Status status_of_refusal(const ServerState& state) {
  if (state.draining) return status_of_stop(StopReason::kDrain);
  return status_of({.code = StatusCode::RESOURCE_EXHAUSTED,
                    .reason = "SERVER_BUSY",
                    .message = "all " + std::to_string(state.limits.running_calls) +
                               " workers are busy and " + std::to_string(state.limits.queued_calls) +
                               " calls wait",
                    .quota = "queued_calls",
                    .retry_after_s = 1});
}

}  // namespace sunfleck
