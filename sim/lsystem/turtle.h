// The turtle: position and right-handed frame (heading, left, up; H x L = U), width, colour. Signs as in ABOP
// and cpfg: + turns left, & pitches down, \ rolls left.
#pragma once

#include <cstdint>

#include "sim/lsystem/lsystem.h"

namespace sunfleck::lsystem {

struct Turtle : TurtleState {
  std::int32_t colour = 0;
  std::int32_t segment = -1;  // the one drawn last on the way here
  double elasticity = 0;
};

Turtle start_turtle(StartFrame frame, double width_m, double elasticity);
Vec3 upright(StartFrame frame);  // what $ calls up

void turn_left(Turtle& turtle, double angle_deg);
void pitch_down(Turtle& turtle, double angle_deg);
void roll_left(Turtle& turtle, double angle_deg);
void turn_around(Turtle& turtle);
// Rolls until the left vector is horizontal: L = V x H, U = H x L; nothing if H is parallel to V.
void level(Turtle& turtle, const Vec3& up);
// ABOP section 2.3.3: turns about H x T by elasticity * |H x T| radians.
void bend_towards(Turtle& turtle, const Vec3& tropism);

}  // namespace sunfleck::lsystem
