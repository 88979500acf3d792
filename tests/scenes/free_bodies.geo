// Bodies that only contact holds, plane or axisymmetric: a round one over a vee, or over a cone if the axis is x = 0; a row of
// round ones over a block; a round one in a bore.
DefineConstant[
  kind = {0, Name "0: whole cylinder in a vee, 1: half ball in a cone, 2: half balls in a row on a block, 3: pin in a bore"},
  gap = {0.3, Name "distance of the bodies along y"}, h = {0.3, Name "element size"}, fine = {0.08, Name "where they touch"}
];
half = kind == 1 || kind == 2;
n = kind == 2 ? 3 : 1;
For i In {1 : n}
  o = 100 * i;
  y = (2 * i - 1) + i * gap - (kind == 3 ? 1 + gap : kind == 2 ? 0 : 1);
  Point(o) = {0, y, 0, h};
  For k In {0 : 3}
    a = k * Pi / 2 + (kind == 0 || kind == 1 ? Pi / 4 : 0);
    If (!half)
      Point(o + 1 + k) = {Cos(a), y + Sin(a), 0, kind == 0 && k < 2 ? h : fine};
    EndIf
  EndFor
  If (half)
    Point(o + 1) = {0, y - 1, 0, kind == 2 ? fine : h};
    Point(o + 2) = {kind == 2 ? 1 : Sqrt(2) / 2, y - (kind == 2 ? 0 : Sqrt(2) / 2), 0, kind == 2 ? h : fine};
    Point(o + 3) = {0, y + 1, 0, kind == 2 ? fine : h};
    Point(o + 4) = {1, y, 0, h};
    Circle(o + 1) = {o + 1, o, o + 2};
    If (kind == 2)
      Circle(o + 2) = {o + 2, o, o + 3};
    Else
      Circle(o + 5) = {o + 2, o, o + 4};
      Circle(o + 2) = {o + 4, o, o + 3};
    EndIf
    Line(o + 3) = {o + 3, o};
    Line(o + 4) = {o, o + 1};
    If (kind == 2)
      Curve Loop(o) = {o + 1, o + 2, o + 3, o + 4};
      Physical Curve(Sprintf("low%g", i)) = {o + 1};
    Else
      Curve Loop(o) = {o + 1, o + 5, o + 2, o + 3, o + 4};
      Physical Curve(Sprintf("low%g", i)) = {o + 1, o + 5};
    EndIf
    Physical Curve(Sprintf("up%g", i)) = {o + 2};
  Else
    For k In {0 : 3}
      Circle(o + 1 + k) = {o + 1 + k, o, o + 1 + (k + 1) % 4};
    EndFor
    Curve Loop(o) = {o + 1 : o + 4};
    Physical Curve(Sprintf("low%g", i)) = {o + 1 : o + 4};
  EndIf
  Plane Surface(o) = {o};
  Physical Surface(Sprintf("body%g", i)) = {o};
EndFor
// what holds them, in y below the touching round body of radius 1 around (0, 0), or below y = 0
w = Sqrt(2);
If (kind == 0)
  x[] = {0, w / 2, 1.5, 2.2, 2.2, -2.2, -2.2, -1.5, -w / 2};
  y[] = {-w, -w / 2, 1.5 - w, 1.5 - w, -w - 1, -w - 1, 1.5 - w, 1.5 - w, -w / 2};
EndIf
If (kind == 1)
  x[] = {0.35, w / 2, 1.1, 1.6, 1.6, 0.35};
  y[] = {0.35 - w, -w / 2, 1.1 - w, 1.1 - w, -w - 0.5, -w - 0.5};
EndIf
If (kind == 2)
  x[] = {0, 1.2, 1.2, 0};
  y[] = {0, 0, -1, -1};
EndIf
If (kind == 3)
  x[] = {2, 2, -2, -2};
  y[] = {2, -2, -2, 2};
EndIf
m = #x[];
For k In {0 : m - 1}
  Point(1001 + k) = {x[k], y[k], 0, ((kind == 0 || kind == 1) && Abs(x[k] * x[k] - 0.5) < 1e-9) || (kind == 2 && k == 0) ? fine : h};
EndFor
For k In {0 : m - 1}
  Line(1001 + k) = {1001 + k, 1001 + (k + 1) % m};
EndFor
Curve Loop(1000) = {-(1000 + m) : -1001};
If (kind == 3)
  Point(2000) = {0, 0, 0, h};
  For k In {0 : 3}
    Point(2001 + k) = {(1 + gap) * Cos(k * Pi / 2), (1 + gap) * Sin(k * Pi / 2), 0, fine};
  EndFor
  For k In {0 : 3}
    Circle(2001 + k) = {2001 + k, 2000, 2001 + (k + 1) % 4};
  EndFor
  Curve Loop(2000) = {2001 : 2004};
  Plane Surface(1000) = {1000, 2000};
  Physical Curve("seat") = {2001 : 2004};
  Physical Curve("base") = {1002};
Else
  Plane Surface(1000) = {1000};
EndIf
If (kind == 0)
  Physical Curve("right") = {1001, 1002};
  Physical Curve("left") = {1008, 1009};
  Physical Curve("base") = {1005};
EndIf
If (kind == 1)
  Physical Curve("seat") = {1001, 1002};
  Physical Curve("base") = {1005};
EndIf
If (kind == 2)
  Physical Curve("seat") = {1001};
  Physical Curve("base") = {1003};
EndIf
Physical Surface("holder") = {1000};
