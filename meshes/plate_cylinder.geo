// A plate clamped at x = 0 over a rigid cylinder that touches it at x = 50 (paper, section 5.2). Lengths in mm.
// The contact patch is 1.5 mm wide at full load: elements are h_contact long for 48 <= x <= 52 and grow away from there.
DefineConstant[
  h_contact = {0.25, Name "element size at the contact"},
  h_far = {2, Name "element size, the largest"},
  n_thick = {4, Name "elements through the thickness"},
  n_width = {10, Name "elements along z"},
  cylinder = {0, Name "1: the cylinder's upper half as a rigid surface"},
  facet = {1, Name "angle of a cylinder facet in degrees"},
  n_cylinder_z = {6, Name "facets along z; a diffuse fit of degree 4 needs five rows of nodes within its support"},
  turn = {0, Name "the facets turned, in facets: 0 a vertex, 0.5 the middle of a facet under x = 50"}
];
thick = 4; width = 20;
x[] = {0, 40, 48, 52, 60, 70};
x_contact = 50;

For i In {0 : 5}
  Point(1 + i) = {x[i], 0, 0};
  Point(11 + i) = {x[i], thick, 0};
  Line(11 + i) = {1 + i, 11 + i};
  Transfinite Curve{11 + i} = n_thick + 1;
EndFor
For i In {0 : 4}
  Line(21 + i) = {1 + i, 2 + i};
  Line(31 + i) = {11 + i, 12 + i};
EndFor
// A geometric row from a first length a to a last length b over l has the ratio (l - a) / (l - b) and 1 + log(b / a) / log(ratio) elements.
h_strip = Min(h_far, 4 * h_contact); // the last length of the rows 40 to 48 and 52 to 60
r_strip = (8 - h_contact) / (8 - h_strip);
r_left = (40 - h_strip) / (40 - h_far);
r_right = (10 - h_strip) / (10 - h_far);
n_strip = (h_strip > h_contact) ? Ceil(Log(h_strip / h_contact) / Log(r_strip)) + 1 : Ceil(8 / h_contact);
n_left = (h_far > h_strip) ? Ceil(Log(h_far / h_strip) / Log(r_left)) + 1 : Ceil(40 / h_far);
n_right = (h_far > h_strip) ? Ceil(Log(h_far / h_strip) / Log(r_right)) + 1 : Ceil(10 / h_far);
Transfinite Curve{21, 31} = n_left + 1 Using Progression 1 / r_left;
Transfinite Curve{22, 32} = n_strip + 1 Using Progression 1 / r_strip;
Transfinite Curve{23, 33} = Ceil(4 / h_contact) + 1;
Transfinite Curve{24, 34} = n_strip + 1 Using Progression r_strip;
Transfinite Curve{25, 35} = n_right + 1 Using Progression r_right;
For i In {0 : 4}
  Curve Loop(1 + i) = {21 + i, 12 + i, -(31 + i), -(11 + i)};
  Plane Surface(1 + i) = {1 + i};
  Transfinite Surface{1 + i};
  Recombine Surface{1 + i};
  out[] = Extrude{0, 0, width}{ Surface{1 + i}; Layers{n_width}; Recombine; };
  plate[i] = out[1];
  bottom[i] = out[2];
  top[i] = out[4];
  If (i == 0)
    clamped = out[5];
  EndIf
EndFor

If (cylinder)
  // beyond the plate's sides by one unit, so that no slave node meets the surface's free edge
  n_cylinder = Round(180 / facet);
  For i In {0 : 2}
    a = Pi * i / 2 + turn * Pi / n_cylinder;
    Point(101 + i) = {x_contact + 20 * Cos(a), -20 + 20 * Sin(a), -1};
  EndFor
  Point(100) = {x_contact, -20, -1};
  Circle(101) = {101, 100, 102};
  Circle(102) = {102, 100, 103};
  Transfinite Curve{101, 102} = n_cylinder / 2 + 1;
  half[] = Extrude{0, 0, width + 2}{ Curve{101, 102}; Layers{n_cylinder_z}; Recombine; };
  Physical Surface("cylinder") = {half[1], half[5]};
EndIf

Physical Volume("plate") = {plate[]};
Physical Surface("clamped") = {clamped};
Physical Surface("plate_bottom") = {bottom[]};
Physical Surface("pressure_strip") = {top[2], top[1], top[3]};
