// Head comment in status_message.h. Details travel in a trailer; gRPC's peers take 8 KiB of trailers by
// default, so that long lists are cut and say so.
#include "server/convert/status_message.h"

#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace sunfleck {
namespace {

constexpr std::size_t kMostDetailBytes = 4000, kMostMessageBytes = 1000;
constexpr char kDomain[] = "sunfleck";

void add_reason(const Failure& failure, google::rpc::Status& status) {
  google::rpc::ErrorInfo info;
  info.set_reason(failure.reason);
  info.set_domain(kDomain);
  if (!failure.incident.empty()) (*info.mutable_metadata())["incident"] = failure.incident;
  status.add_details()->PackFrom(info);
}

void add_violations(const std::vector<Violation>& violations, google::rpc::Status& status) {
  google::rpc::BadRequest bad;
  for (std::size_t i = 0; i < violations.size(); ++i) {
    google::rpc::BadRequest::FieldViolation& violation = *bad.add_field_violations();
    if (bad.ByteSizeLong() > kMostDetailBytes) {
      violation.set_field("*");
      violation.set_description("and " + std::to_string(violations.size() - i) + " more");
      break;
    }
    violation.set_field(violations[i].field);
    violation.set_description(violations[i].description.substr(0, 800));
  }
  status.add_details()->PackFrom(bad);
}

void add_quota(const Failure& failure, google::rpc::Status& status) {
  google::rpc::QuotaFailure quota;
  google::rpc::QuotaFailure::Violation& violation = *quota.add_violations();
  violation.set_subject(failure.quota);
  violation.set_description(failure.message.substr(0, 400));
  status.add_details()->PackFrom(quota);
}

void add_retry(double after_s, google::rpc::Status& status) {
  google::rpc::RetryInfo retry;
  const auto whole = static_cast<std::int64_t>(after_s);
  retry.mutable_retry_delay()->set_seconds(whole);
  retry.mutable_retry_delay()->set_nanos(
      static_cast<std::int32_t>((after_s - static_cast<double>(whole)) * 1e9));
  status.add_details()->PackFrom(retry);
}

ErrorKind kind_of(grpc::StatusCode code) {
  switch (code) {
    case grpc::StatusCode::INVALID_ARGUMENT:
      return ErrorKind::kInvalidInput;
    case grpc::StatusCode::NOT_FOUND:
      return ErrorKind::kNotFound;
    case grpc::StatusCode::RESOURCE_EXHAUSTED:
      return ErrorKind::kLimitExceeded;
    case grpc::StatusCode::CANCELLED:
      return ErrorKind::kCancelled;
    default:
      return ErrorKind::kInputOutput;
  }
}

const char* name_of(grpc::StatusCode code) {
  switch (code) {
    case grpc::StatusCode::INVALID_ARGUMENT:
      return "the server refused the request";
    case grpc::StatusCode::NOT_FOUND:
      return "not found";
    case grpc::StatusCode::RESOURCE_EXHAUSTED:
      return "a limit of the server is met";
    case grpc::StatusCode::CANCELLED:
      return "cancelled";
    case grpc::StatusCode::DEADLINE_EXCEEDED:
      return "the deadline passed";
    case grpc::StatusCode::UNAVAILABLE:
      return "the server does not answer";
    case grpc::StatusCode::UNIMPLEMENTED:
      return "the server does not know this call";
    default:
      return "the server failed";
  }
}

// What a person can do, from the details.
std::string remedy_of(const google::rpc::Status& details, std::string& listed) {
  std::string remedy;
  for (const google::protobuf::Any& any : details.details()) {
    google::rpc::BadRequest bad;
    google::rpc::RetryInfo retry;
    google::rpc::ErrorInfo info;
    if (any.UnpackTo(&bad)) {
      for (const auto& v : bad.field_violations()) listed += "\n  " + v.field() + ": " + v.description();
    } else if (any.UnpackTo(&retry)) {
      remedy = "try again in " + std::to_string(retry.retry_delay().seconds() + 1) + " s";
    } else if (any.UnpackTo(&info) && info.metadata().contains("incident")) {
      remedy = "the server's log has more under incident " + info.metadata().at("incident");
    }
  }
  return remedy;
}

}  // namespace

grpc::Status status_of(const Failure& failure) {
  google::rpc::Status status;
  status.set_code(static_cast<int>(failure.code));
  status.set_message(failure.message.substr(0, kMostMessageBytes));
  add_reason(failure, status);
  if (!failure.violations.empty()) add_violations(failure.violations, status);
  if (!failure.quota.empty()) add_quota(failure, status);
  if (failure.retry_after_s > 0) add_retry(failure.retry_after_s, status);
  return {failure.code, status.message(), status.SerializeAsString()};
}

Error error_of(const grpc::Status& status) {
  google::rpc::Status details;
  std::string listed;
  const bool readable = details.ParseFromString(status.error_details());
  const std::string remedy = readable ? remedy_of(details, listed) : std::string();
  const std::string problem = listed.empty() ? status.error_message() : listed;
  return {kind_of(status.error_code()), name_of(status.error_code()), problem, remedy};
}

}  // namespace sunfleck
