// A block of quadrilaterals, and a half cylinder with a hole that touches its upper face, in the plane.
DefineConstant[
  h = {0.5, Name "element size, block"}, h_cylinder = {0.25, Name "element size, cylinder"},
  length = {20, Name "length of the block"}, height = {5, Name "height of the block"},
  radius = {4, Name "radius of the cylinder"},
  hole = {2.5, Name "radius of the hole"}, x = {7.5, Name "place of the cylinder's axis"}
];
Point(1) = {0, 0, 0};
Point(2) = {length, 0, 0};
Point(3) = {length, height, 0};
Point(4) = {0, height, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = Round(length / h) + 1;
Transfinite Curve{2, 4} = Round(height / h) + 1;
Transfinite Surface{1};
Recombine Surface{1};

y = height + radius;
Point(10) = {x, y, 0};
Point(11) = {x - radius, y, 0};
Point(12) = {x, y - radius, 0};
Point(13) = {x + radius, y, 0};
Point(14) = {x - hole, y, 0};
Point(15) = {x, y - hole, 0};
Point(16) = {x + hole, y, 0};
Circle(11) = {11, 10, 12};
Circle(12) = {12, 10, 13};
Line(13) = {13, 16};
Circle(14) = {16, 10, 15};
Circle(15) = {15, 10, 14};
Line(16) = {14, 11};
Line(17) = {12, 15};
Curve Loop(2) = {11, 17, 15, 16};
Plane Surface(2) = {2};
Curve Loop(3) = {12, 13, 14, -17};
Plane Surface(3) = {3};
Transfinite Curve{11, 12, 14, 15} = Round(Pi / 2 * radius / h_cylinder) + 1;
Transfinite Curve{13, 16, 17} = Round((radius - hole) / h_cylinder) + 1;
Transfinite Surface{2, 3};
Recombine Surface{2, 3};

Physical Surface("block") = {1};
Physical Surface("cylinder") = {2, 3};
Physical Curve("block_bottom") = {1};
Physical Curve("block_top") = {3};
Physical Curve("arc") = {11, 12};
Physical Curve("holder") = {13, 14, 15, 16};
