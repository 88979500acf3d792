// The bodies of hertz_sphere.geo, their interface meshed by quadrilaterals where the mesher puts them and swept through the bodies: the sphere's cut is
// then a copy of its sole, the pressure on it has the same resultant. Lengths in mm.
DefineConstant[
  radius = {50, Name "radius of the sphere"}, size = {16, Name "width and height of the bodies"},
  zone = {1.5, Name "distance from the first touch that is meshed evenly"}, n = {6, Name "elements along that length, sphere"},
  ratio = {0.8, Name "the block's element size over the sphere's: the two meshes do not match"},
  growth = {1, Name "by how much the size grows per distance beyond, along the surface"},
  layers = {2, Name "growth of a layer over the one before it, beyond"},
  apart = {1e-6, Name "gap at the first touch: without one this kernel would merge the two bodies' points there"},
  uneven = {0.1, Name "part by which the size goes up and down: another mesh for each seed"}, seed = {1, Name "of it"}
];
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.Algorithm = 6;
Mesh.RecombinationAlgorithm = 3; // nothing but quadrilaterals
Point(1) = {0, radius, 0}; // the sphere's centre, and those of the circles that the planes x = size and z = size cut out of it
Point(2) = {size, radius, 0};
Point(3) = {0, radius, size};
For b In {0 : 1} // sphere, block
  h = zone / Ceil(b ? n / ratio : n);
  o = 1000 * (b + 1);
  rise = b ? -apart : radius - Sqrt(radius^2 - size^2);
  top = b ? -apart : radius - Sqrt(radius^2 - 2 * size^2);
  Point(o) = {0, b ? -apart : 0, 0};
  Point(o + 1) = {size, rise, 0};
  Point(o + 2) = {size, top, size};
  Point(o + 3) = {0, rise, size};
  If (b)
    Line(o) = {o, o + 1};
    Line(o + 1) = {o + 1, o + 2};
    Line(o + 2) = {o + 2, o + 3};
    Line(o + 3) = {o + 3, o};
  Else
    Circle(o) = {o, 1, o + 1};
    Circle(o + 1) = {o + 1, 2, o + 2};
    Circle(o + 2) = {o + 2, 3, o + 3};
    Circle(o + 3) = {o + 3, 1, o};
  EndIf
  Curve Loop(o) = {o : o + 3};
  If (b)
    Plane Surface(o) = {o};
  Else
    Surface(o) = {o} In Sphere{1};
  EndIf
  Field[o] = MathEval;
  Field[o].F = Sprintf("%g * (1 + %g * Sin(%g * x + %g) * Sin(%g * z + %g)) + %g * (Sqrt(x*x+z*z) - %g + abs(Sqrt(x*x+z*z) - %g))", h, uneven, 5 / zone, 3 * seed + b, 7 / zone, 2 * seed + b,
    growth / 2, zone, zone);
  Field[o + 1] = Restrict; Field[o + 1].IField = o; Field[o + 1].EdgesList = {o : o + 3}; Field[o + 1].FacesList = {o};
  n_zone = Round(zone / h);
  n_far = Ceil(Log(1 + (size - zone) * (layers - 1) / (layers * h)) / Log(layers));
  each[] = {};
  until[] = {};
  For i In {1 : n_zone + n_far}
    each[] += {1};
    until[] += {(i <= n_zone ? i * h : zone + (size - zone) * (layers^(i - n_zone) - 1) / (layers^n_far - 1)) / size};
  EndFor
  Recombine Surface{o};
  body~{b}[] = Extrude {0, b ? -size : size, 0} { Surface{o}; Layers{each[], until[]}; Recombine; };
EndFor
Field[100] = Min;
Field[100].FieldsList = {1001, 2001};
Background Field = 100;

Physical Volume("sphere") = {body_0[1]};
Physical Volume("block") = {body_1[1]};
Physical Surface("sphere_sole") = {1000};
Physical Surface("sphere_cut") = {body_0[0]};
Physical Surface("block_top") = {2000};
Physical Surface("block_bottom") = {body_1[0]};
Physical Surface("symmetry_x") = {body_0[5], body_1[5]};
Physical Surface("symmetry_z") = {body_0[2], body_1[2]};
