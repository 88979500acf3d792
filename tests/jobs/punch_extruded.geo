// A block under a rigid punch with rounded edges. The punch is a profile that is extruded in one layer, with one face
// for its flat. Lengths in mm.
SetFactory("OpenCASCADE");
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
a = 20; h = 10; d = 20; flat = 7; r = 3; gap = 0.05;
Box(1) = {-a, -h, 0, 2 * a, h, d};
Point(100) = {-flat - r, gap + r + 4, -5}; Point(101) = {-flat - r, gap + r, -5}; Point(102) = {-flat, gap, -5};
Point(103) = {flat, gap, -5}; Point(104) = {flat + r, gap + r, -5}; Point(105) = {flat + r, gap + r + 4, -5};
Point(106) = {-flat, gap + r, -5}; Point(107) = {flat, gap + r, -5};
Line(200) = {100, 101}; Circle(201) = {101, 106, 102}; Line(202) = {102, 103}; Circle(203) = {103, 107, 104};
Line(204) = {104, 105};
Transfinite Curve{:} = Round(6 * refine) + 1;
long() = Curve In BoundingBox{-a - 1, -h - 1, -1, a + 1, 1, d + 1};
For i In {0 : #long() - 1}
  box() = BoundingBox Curve{long(i)};
  If (box(3) - box(0) > a)
    Transfinite Curve{long(i)} = Round(20 * refine) + 1;
  EndIf
EndFor
Transfinite Surface{1 : 6}; Recombine Surface{1 : 6}; Transfinite Volume{1};
Transfinite Curve{200, 202, 204} = 2; Transfinite Curve{201, 203} = Round(6 * refine) + 1;
side() = Extrude{0, 0, d + 10}{ Curve{200 : 204}; Layers{1}; Recombine; };
Physical Volume("block") = {1};
Physical Surface("bottom") = Surface In BoundingBox{-a - 1, -h - 0.1, -1, a + 1, -h + 0.1, d + 1};
Physical Surface("top") = Surface In BoundingBox{-a - 1, -0.01, -1, a + 1, 0.01, d + 1};
Physical Surface("punch") = {side(1), side(5), side(9), side(13), side(17)};
