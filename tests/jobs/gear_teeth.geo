// Two gear teeth with involute flanks that touch at the pitch point; in the plane. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
rp = 50; al = 20*Pi/180; rb = rp*Cos(al); m = 5;
fine = 0.08 / refine; mid = 0.5 / refine; coarse = 2.5 / refine;
// tooth k: centre (cx, cy), angle turn; the flank in contact is an involute of the base circle through (0, 0)
n = 12;
Macro Tooth
  // wheel about (0, -rp) before the turn by half a turn; pitch point at (0, 0); tooth to the left (side -1) of its flank
  invp = Tan(al) - al;
  For i In {0 : n}
    r = rb + 0.2 + i*(rp + m - rb - 0.2)/n;
    t = Sqrt(r*r/(rb*rb) - 1);
    an = -((t - Atan(t)) - invp); // angle from the radius through the pitch point, to the left when further out
    d = Fabs(r - rp);
    size = mid;
    If (d < 2)
      size = fine;
    EndIf
    X = -r*Sin(-an); Y = r*Cos(an) - rp;
    Point(b + i) = {s*X, s*Y, 0, size};
  EndFor
  w = Pi*m/2/rp; // width of the tooth at the pitch circle as an angle
  For i In {0 : n}
    r = rb + 0.2 + i*(rp + m - rb - 0.2)/n;
    t = Sqrt(r*r/(rb*rb) - 1);
    an = (t - Atan(t)) - invp - w;
    X = r*Sin(an); Y = r*Cos(an) - rp;
    Point(b + 50 + i) = {s*X, s*Y, 0, mid*2};
  EndFor
  BSpline(b) = {b : b + n}; Transfinite Curve{b} = 150*refine;
  BSpline(b + 1) = {b + 50 + n : b + 50 : -1};
  Line(b + 2) = {b + n, b + 50 + n};
  // body
  ri = rp - 18; h = 0.3;
  Point(b + 80) = {0, -s*rp, 0};
  Point(b + 81) = {s*ri*Sin(-w/2 - h), s*(ri*Cos(-w/2 - h) - rp), 0, coarse};
  Point(b + 82) = {s*ri*Sin(-w/2 + h), s*(ri*Cos(-w/2 + h) - rp), 0, coarse};
  ro = rp - 1.3*m;
  Point(b + 83) = {s*ro*Sin(-w/2 - h), s*(ro*Cos(-w/2 - h) - rp), 0, coarse};
  Point(b + 84) = {s*ro*Sin(-w/2 + h), s*(ro*Cos(-w/2 + h) - rp), 0, coarse};
  af = -(Sqrt((rb + 0.2)^2/rb^2 - 1) - Atan(Sqrt((rb + 0.2)^2/rb^2 - 1)) - invp);
  Point(b + 85) = {s*ro*Sin(af), s*(ro*Cos(af) - rp), 0, 2*mid};
  Circle(b + 3) = {b + 81, b + 80, b + 82};
  Line(b + 4) = {b + 82, b + 84};
  Line(b + 5) = {b + 84, b + 85};
  Line(b + 8) = {b + 85, b};
  Line(b + 6) = {b + 50, b + 83};
  Line(b + 7) = {b + 83, b + 81};
  Curve Loop(b) = {b + 3, b + 4, b + 5, b + 8, b, b + 2, b + 1, b + 6, b + 7};
  Plane Surface(b) = {b};
Return
b = 1000; s = 1; Call Tooth;
b = 2000; s = -1; Call Tooth;
Physical Surface("pinion") = {1000}; Physical Surface("gear") = {2000};
Physical Curve("pinion_flank") = {1000}; Physical Curve("gear_flank") = {2000};
Physical Curve("pinion_hub") = {1003}; Physical Curve("gear_hub") = {2003};
