// A cylinder pressed on a block, half of both, in the plane: x = 0 is the plane of symmetry, the first touch is at the origin. Lengths in mm.
// Only the lower half of the cylinder is there: it is loaded through its cut y = radius.
SetFactory("OpenCASCADE"); // the built-in kernel would merge the two bodies' coincident points
DefineConstant[
  radius = {50, Name "radius of the cylinder"},
  size = {200, Name "width and height of the whole block"},
  h = {0.2, Name "element size at the contact, cylinder"},
  ratio = {0.8, Name "the block's element size at the contact over the cylinder's: the two meshes do not match"},
  zone = {8, Name "length of the surface that is meshed with that size, from the plane of symmetry on"},
  core = {0, Name "depth below that zone that is meshed with that size too"},
  rows = {1, Name "1: the core's quadrilaterals lie in rows, 0: where the mesher puts them"},
  growth = {0.15, Name "element size: by how much it grows per distance beyond"},
  jitter = {0, Name "largest move of a node of that length, in elements"}, seed = {1, Name "of the moves"}
];
angle = zone / radius;
Point(3) = {radius, radius, 0};
Point(4) = {0, radius, 0};
n_0 = Ceil(zone / h);
Point(100) = {0, 0, 0};
sole[] = {};
For i In {1 : n_0}
  x = 43758.5453 * Sin(12.9898 * (i + 7 * seed)); // the digits behind the point serve as random numbers
  moved = angle * (i == n_0 ? i : i + jitter * (2 * (x - Floor(x)) - 1)) / n_0;
  Point(100 + i) = {radius * Sin(moved), radius * (1 - Cos(moved)), 0};
  Circle(100 + i) = {99 + i, 4, 100 + i};
  sole[] += {100 + i};
EndFor
Circle(2) = {100 + n_0, 4, 3};
Line(3) = {3, 4};
If (core > 0)
  m_0 = Ceil(core / h);
  Point(5) = {0, core, 0};
  Point(6) = {radius * Sin(angle), core, 0};
  Line(4) = {4, 5};
  Line(5) = {5, 100};
  Line(6) = {100 + n_0, 6};
  Line(7) = {6, 5};
  Curve Loop(1) = {2, 3, 4, -7, -6};
  Curve Loop(2) = {sole[], 6, 7, 5};
  Plane Surface(2) = {2};
  Transfinite Curve{5, 6} = m_0 + 1;
  Transfinite Curve{7} = n_0 + 1;
  If (rows)
    Transfinite Surface{2} = {100, 100 + n_0, 6, 5};
  EndIf
  cylinder[] = {1, 2};
  axis[] = {4, 5};
  front_0[] = {6, 7};
Else
  Line(4) = {4, 100};
  Curve Loop(1) = {sole[], 2, 3, 4};
  cylinder[] = {1};
  axis[] = {4};
  front_0[] = {sole[]};
EndIf
Plane Surface(1) = {1};

Point(12) = {0, -size, 0};
Point(13) = {size / 2, -size, 0};
Point(14) = {size / 2, 0, 0};
n_1 = Ceil(zone / (ratio * h));
Point(10000) = {0, 0, 0};
top[] = {};
For i In {1 : n_1}
  x = 43758.5453 * Sin(78.233 * (i + 7 * seed));
  Point(10000 + i) = {zone * (i == n_1 ? i : i + jitter * (2 * (x - Floor(x)) - 1)) / n_1, 0, 0};
  Line(10000 + i) = {10000 + i, 9999 + i};
  top[] = {10000 + i, top[]};
EndFor
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 10000 + n_1};
If (core > 0)
  m_1 = Ceil(core / (ratio * h));
  Point(15) = {0, -core, 0};
  Point(16) = {zone, -core, 0};
  Line(11) = {15, 12};
  Line(15) = {10000, 15};
  Line(16) = {16, 10000 + n_1};
  Line(17) = {15, 16};
  Curve Loop(11) = {11, 12, 13, 14, -16, -17};
  Curve Loop(12) = {15, 17, 16, top[]};
  Plane Surface(12) = {12};
  Transfinite Curve{15, 16} = m_1 + 1;
  Transfinite Curve{17} = n_1 + 1;
  If (rows)
    Transfinite Surface{12} = {10000, 15, 16, 10000 + n_1};
  EndIf
  block[] = {11, 12};
  axis[] += {11, 15};
  front_1[] = {16, 17};
Else
  Line(11) = {10000, 12};
  Curve Loop(11) = {11, 12, 13, 14, top[]};
  block[] = {11};
  axis[] += {11};
  front_1[] = {top[]};
EndIf
Plane Surface(11) = {11};

// The size follows the distance from the contact zone of each body, or from its core.
Mesh.CharacteristicLengthExtendFromBoundary = 0;
Mesh.CharacteristicLengthFromPoints = 0;
Field[1] = Distance; Field[1].EdgesList = {front_0[]}; Field[1].NNodesByEdge = 20;
Field[2] = MathEval; Field[2].F = Sprintf("%g + %g * F1", h, growth);
Field[3] = Restrict; Field[3].IField = 2; Field[3].EdgesList = {front_0[], 2, 3, 4}; Field[3].FacesList = {1};
Field[11] = Distance; Field[11].EdgesList = {front_1[]}; Field[11].NNodesByEdge = 20;
Field[12] = MathEval; Field[12].F = Sprintf("%g + %g * F11", ratio * h, growth);
Field[13] = Restrict; Field[13].IField = 12; Field[13].EdgesList = {11 : 14, front_1[]}; Field[13].FacesList = {11};
sizes[] = {3, 13};
If (core > 0)
  Field[4] = MathEval; Field[4].F = Sprintf("%g", h);
  Field[5] = Restrict; Field[5].IField = 4; Field[5].EdgesList = {5}; Field[5].FacesList = {2};
  Field[14] = MathEval; Field[14].F = Sprintf("%g", ratio * h);
  Field[15] = Restrict; Field[15].IField = 14; Field[15].EdgesList = {15}; Field[15].FacesList = {12};
  sizes[] += {5, 15};
EndIf
Field[100] = Min;
Field[100].FieldsList = {sizes[]};
Background Field = 100;
Transfinite Curve{sole[], top[]} = 2; // each of these is one face
Mesh.Algorithm = 6;
Recombine Surface{cylinder[], block[]};

Physical Surface("cylinder") = {cylinder[]};
Physical Surface("block") = {block[]};
Physical Curve("cylinder_sole") = {sole[], 2};
Physical Curve("cylinder_cut") = {3};
Physical Curve("block_top") = {14, top[]};
Physical Curve("block_bottom") = {12};
Physical Curve("symmetry_x") = {axis[]};
