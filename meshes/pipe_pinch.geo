// A quarter of a pipe under a plate (paper, section 5.1): cross-section in (x, y), extruded along z. Lengths in mm.
// The plate's elements are about as long as the pipe's outer ones; z lines of both bodies coincide.
SetFactory("OpenCASCADE"); // the built-in kernel would merge the pipe's crown and the plate's corner when it extrudes
DefineConstant[
  n_arc = {24, Name "elements around the quarter"},
  n_wall = {1, Name "elements through the wall"},
  n_len = {10, Name "elements along z, both bodies"},
  n_plate_x = {0, Name "elements along the plate; 0: half of n_arc, 6.25 mm against 6.54 mm on the pipe"},
  n_plate_y = {1, Name "elements through the plate"}
];
r_in = 90; r_out = 100; plate = 75; thick = 20; len = 200;
nx = (n_plate_x > 0) ? n_plate_x : Ceil(n_arc / 2);

Point(1) = {0, 0, 0};
Point(2) = {r_in, 0, 0};
Point(3) = {r_out, 0, 0};
Point(4) = {0, r_out, 0};
Point(5) = {0, r_in, 0};
Line(1) = {2, 3};
Circle(2) = {3, 1, 4};
Line(3) = {4, 5};
Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = n_wall + 1;
Transfinite Curve{2, 4} = n_arc + 1;

Point(11) = {0, r_out, 0};
Point(12) = {plate, r_out, 0};
Point(13) = {plate, r_out + thick, 0};
Point(14) = {0, r_out + thick, 0};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 11};
Curve Loop(11) = {11, 12, 13, 14};
Plane Surface(11) = {11};
Transfinite Curve{11, 13} = nx + 1;
Transfinite Curve{12, 14} = n_plate_y + 1;

Transfinite Surface{1, 11};
Recombine Surface{1, 11};
pipe[] = Extrude{0, 0, len}{ Surface{1}; Layers{n_len}; Recombine; };
plate[] = Extrude{0, 0, len}{ Surface{11}; Layers{n_len}; Recombine; };

Physical Volume("pipe") = {pipe[1]};
Physical Volume("plate") = {plate[1]};
Physical Surface("symmetry_x") = {pipe[4], plate[5]};
Physical Surface("symmetry_z") = {1, 11};
Physical Surface("pipe_cut") = {pipe[2]};
Physical Surface("pipe_outer") = {pipe[3]};
Physical Surface("pipe_inner") = {pipe[5]};
Physical Surface("plate_bottom") = {plate[2]};
Physical Surface("plate_top") = {plate[4]};
