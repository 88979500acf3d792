// A rubber boot with a waist around a mandrel, axisymmetric: x = r, y = z. The boot's middle line is a cosine between
// two straight collars. Lengths in mm.
DefineConstant[
  refine = {1, Name "divides all element sizes"},
  collar = {22, Name "radius of the collars, middle line"}, waist = {15, Name "radius of the waist, middle line"},
  wall = {2, Name "thickness"}, height = {36, Name "of the boot between the collars"}, mandrel = {12, Name "its radius"}
];
n = Round(60 * refine);
layers = Round(4 * refine);
For i In {0 : 40}
  z = height * (i / 40 - 0.5);
  r = waist + (collar - waist) * (1 - Cos(2 * Pi * z / height)) / 2;
  slope = (collar - waist) * Pi / height * Sin(2 * Pi * z / height); // dr/dz
  w = wall / 2 / Sqrt(1 + slope^2);
  Point(100 + i) = {r - w, z + w * slope, 0, 1};
  Point(200 + i) = {r + w, z - w * slope, 0, 1};
EndFor
Spline(1) = {100 : 140};
Spline(2) = {200 : 240};
Line(3) = {100, 200};
Line(4) = {140, 240};
Transfinite Curve{1, 2} = n + 1;
Transfinite Curve{3, 4} = layers + 1;
Curve Loop(1) = {3, 2, -4, -1};
Plane Surface(1) = {1};
Transfinite Surface{1};
Recombine Surface{1};

Point(11) = {mandrel - 5, -14, 0, 1};
Point(12) = {mandrel, -14, 0, 1};
Point(13) = {mandrel, 14, 0, 1};
Point(14) = {mandrel - 5, 14, 0, 1};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 11};
Curve Loop(2) = {11 : 14};
Plane Surface(2) = {2};
Transfinite Curve{12, 14} = Round(42 * refine) + 1;
Transfinite Curve{11, 13} = Round(3 * refine) + 1;
Transfinite Surface{2};
Recombine Surface{2};

Physical Surface("boot") = {1};
Physical Surface("mandrel") = {2};
Physical Curve("boot_inside") = {1};
Physical Curve("boot_low") = {3};
Physical Curve("boot_up") = {4};
Physical Curve("mandrel_skin") = {12};
Physical Curve("mandrel_end") = {11};
