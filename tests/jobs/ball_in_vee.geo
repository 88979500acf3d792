// A ball above a vee groove along z, the half z >= 0, or the quarter x, z >= 0. Lengths in mm. The finely meshed parts
// are about the points where the ball meets the flanks.
SetFactory("OpenCASCADE");
DefineConstant[
  refine = {1, Name "divides all element sizes"},
  radius = {5, Name "of the ball"}, gap = {0.02, Name "between ball and flanks"},
  quarter = {0, Name "1: the quarter x >= 0"}
];
s = Sqrt(0.5);
fine = 0.15 / refine;
coarse = 1.6 / refine;
depth = (radius + gap) / s; // of the vee's bottom below the ball's centre
Sphere(1) = {0, 0, 0, radius};
left = quarter ? 0 : -radius;
Box(2) = {left, -radius, 0, radius - left, 2 * radius, radius};
BooleanIntersection(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };

height = 6.5; // of the groove
base = 3;
Point(1001) = {0, -depth, 0};
Point(1002) = {height, -depth + height, 0};
Point(1003) = {height, -depth - base, 0};
Point(1004) = {-height, -depth - base, 0};
Point(1005) = {-height, -depth + height, 0};
For i In {1 : 5}
  Line(1000 + i) = {1000 + i, 1000 + i % 5 + 1};
EndFor
Curve Loop(1001) = {-1005, -1004, -1003, -1002, -1001};
Plane Surface(1001) = {1001};
block[] = Extrude {0, 0, 5} { Surface{1001}; };
groove = block[1];
If (quarter)
  Box(5) = {0, -50, -50, 50, 100, 100};
  BooleanIntersection(6) = { Volume{groove}; Delete; }{ Volume{5}; Delete; };
  groove = 6;
EndIf

Point(2000) = {0, 0, 0}; // the ball's centre, for a probe
Point(2001) = {radius * s, -radius * s, 0};
Point(2002) = {-radius * s, -radius * s, 0};
e = 0.01;
far = 10;
cut[] = Surface In BoundingBox {-far, -far, -e, far, far, e}; // z = 0 of both bodies
skin[] = Boundary{ Volume{3}; };
middle[] = skin[];
skin[] -= cut[];
middle[] -= skin[];
side[] = Surface In BoundingBox {-e, -far, -e, e, far, far}; // x = 0 of both bodies
skin[] -= side[];
If (!quarter)
  Point{2000} In Surface{middle[0]};
EndIf
flanks[] = Surface In BoundingBox {-e, -depth - e, -e, far, height - depth + e, 5 + e};
flanks[] += Surface In BoundingBox {-far, -depth - e, -e, e, height - depth + e, 5 + e};
flanks[] -= cut[];
flanks[] -= side[];
flanks[] -= skin[];
flanks[] -= Surface In BoundingBox {-far, -depth - e, 5 - e, far, far, 5 + e};
bottom[] = Surface In BoundingBox {-far, -depth - base - e, -e, far, -depth - base + e, 5 + e};
Field[1] = Distance;
Field[1].PointsList = {2001, 2002};
Field[2] = Threshold;
Field[2].InField = 1;
Field[2].SizeMin = fine;
Field[2].SizeMax = coarse;
Field[2].DistMin = 0.6;
Field[2].DistMax = 3;
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

Physical Volume("ball") = {3};
Physical Volume("groove") = {groove};
Physical Surface("ball_skin") = {skin[]};
Physical Surface("flanks") = {flanks[]};
Physical Surface("symmetry") = {cut[]};
If (quarter)
  Physical Surface("side") = {side[]};
EndIf
Physical Surface("groove_bottom") = {bottom[]};
