C     J2 plasticity with linear hardening for umat.py. PROPS: E, nu, yield stress, slope.
C     STATEV: equivalent plastic strain.
      SUBROUTINE UMAT(STRESS,STATEV,DDSDDE,SSE,SPD,SCD,RPL,DDSDDT,
     1 DRPLDE,DRPLDT,STRAN,DSTRAN,TIME,DTIME,TEMP,DTEMP,PREDEF,DPRED,
     2 CMNAME,NDI,NSHR,NTENS,NSTATV,PROPS,NPROPS,COORDS,DROT,PNEWDT,
     3 CELENT,DFGRD0,DFGRD1,NOEL,NPT,LAYER,KSPT,JSTEP,KINC)
      INCLUDE 'ABA_PARAM.INC'
      CHARACTER*80 CMNAME
      DIMENSION STRESS(NTENS),STATEV(NSTATV),DDSDDE(NTENS,NTENS),
     1 DDSDDT(NTENS),DRPLDE(NTENS),STRAN(NTENS),DSTRAN(NTENS),TIME(2),
     2 PREDEF(1),DPRED(1),PROPS(NPROPS),COORDS(3),DROT(3,3),
     3 DFGRD0(3,3),DFGRD1(3,3),JSTEP(4)
      DIMENSION DEV(6), UNIT(6)
      G = PROPS(1)/(2*(1 + PROPS(2)))
      BULK = PROPS(1)/(3*(1 - 2*PROPS(2)))
      YIELD = PROPS(3) + PROPS(4)*STATEV(1)
      VOLUME = 0
      PRESS = 0
      DO I = 1, 3
        VOLUME = VOLUME + DSTRAN(I)
        PRESS = PRESS + STRESS(I)/3
      END DO
      SQ = 0
      DO I = 1, NTENS
        IF (I .LE. 3) THEN
          UNIT(I) = 1
          DEV(I) = STRESS(I) - PRESS + 2*G*(DSTRAN(I) - VOLUME/3)
          SQ = SQ + DEV(I)**2
        ELSE
          UNIT(I) = 0
          DEV(I) = STRESS(I) + G*DSTRAN(I)
          SQ = SQ + 2*DEV(I)**2
        END IF
      END DO
      Q = SQRT(1.5D0*SQ)
      THETA = 1
      FALL = 0
      DP = 0
      IF (Q .GT. YIELD*(1 + 1D-12)) THEN
        DP = (Q - YIELD)/(3*G + PROPS(4))
        THETA = 1 - 3*G*DP/Q
        FALL = THETA - PROPS(4)/(3*G + PROPS(4))
      END IF
      DO I = 1, NTENS
        DO J = 1, NTENS
          DDSDDE(I,J) = (BULK - 2*G*THETA/3)*UNIT(I)*UNIT(J)
          IF (SQ .GT. 0) THEN
            DDSDDE(I,J) = DDSDDE(I,J) - 2*G*FALL*DEV(I)*DEV(J)/SQ
          END IF
        END DO
        DDSDDE(I,I) = DDSDDE(I,I) + G*THETA*(1 + UNIT(I))
        STRESS(I) = THETA*DEV(I) + (PRESS + BULK*VOLUME)*UNIT(I)
      END DO
      STATEV(1) = STATEV(1) + DP
      SPD = SPD + DP*(YIELD + PROPS(4)*DP/2)
      SSE = (THETA*Q)**2/(6*G) + (PRESS + BULK*VOLUME)**2/(2*BULK)
      RETURN
      END
