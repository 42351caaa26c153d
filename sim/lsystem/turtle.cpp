#include "sim/lsystem/turtle.h"

#include <cmath>

namespace sunfleck::lsystem {
namespace {

// Turns `a` towards `b` and `b` away from `a`.
void rotate_pair(Vec3& a, Vec3& b, double angle_deg) {
  const double angle_rad = radians_from_degrees(angle_deg);
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  const Vec3 turned = a * c + b * s;
  b = b * c - a * s;
  a = turned;
}

Vec3 rotated(const Vec3& v, const Vec3& axis, double angle_rad) {  // Rodrigues' formula
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return v * c + glm::cross(axis, v) * s + axis * (glm::dot(axis, v) * (1 - c));
}

}  // namespace

Turtle start_turtle(StartFrame frame, double width_m, double elasticity) {
  Turtle turtle;
  turtle.width_m = width_m;
  turtle.elasticity = elasticity;
  turtle.heading = upright(frame);
  turtle.left = {-1, 0, 0};
  turtle.up = frame == StartFrame::kAbop ? Vec3(0, 0, 1) : Vec3(0, -1, 0);
  return turtle;
}

Vec3 upright(StartFrame frame) { return frame == StartFrame::kAbop ? Vec3(0, 1, 0) : Vec3(0, 0, 1); }

void turn_left(Turtle& turtle, double angle_deg) { rotate_pair(turtle.heading, turtle.left, angle_deg); }
void pitch_down(Turtle& turtle, double angle_deg) { rotate_pair(turtle.heading, turtle.up, -angle_deg); }
void roll_left(Turtle& turtle, double angle_deg) { rotate_pair(turtle.left, turtle.up, -angle_deg); }

void turn_around(Turtle& turtle) {
  turtle.heading = -turtle.heading;
  turtle.left = -turtle.left;
}

void level(Turtle& turtle, const Vec3& up) {
  const Vec3 sideways = glm::cross(up, turtle.heading);
  const double length = glm::length(sideways);
  if (length < 1e-9) return;
  turtle.left = sideways / length;
  turtle.up = glm::cross(turtle.heading, turtle.left);
}

void bend_towards(Turtle& turtle, const Vec3& tropism) {
  const Vec3 torque = glm::cross(turtle.heading, tropism);
  const double size = glm::length(torque);
  if (turtle.elasticity == 0 || size < 1e-15) return;
  const Vec3 axis = torque / size;
  const double angle_rad = turtle.elasticity * size;
  turtle.heading = rotated(turtle.heading, axis, angle_rad);
  turtle.left = rotated(turtle.left, axis, angle_rad);
  turtle.up = rotated(turtle.up, axis, angle_rad);
}

}  // namespace sunfleck::lsystem
