"""Independent numerics: closure as stated, solved by Newton from many starts, NumPy alone."""
import numpy as np, softkin
P={p.name:None for p in softkin.RodWrist.PARAMETERS}
from derive.mechanisms.softkin_rodwrist import MECHANISM
g={p.name:p.nominal for p in MECHANISM.parameters}
r=softkin.RodWrist(**g)
def R(p,q):
    cp,sp,cr,sr=np.cos(p),np.sin(p),np.cos(q),np.sin(q)
    return np.array([[cp,sp*sr,sp*cr],[0,cr,-sr],[-sp,cp*sr,cp*cr]])
def res(u,a):
    M=R(*u); out=[]
    for i in (1,2):
        b=np.array([g[f"base_{i}_{c}"] for c in "xyz"]); t=np.array([g[f"platform_{i}_{c}"] for c in "xyz"])
        A=np.radians(a[i-1]); e=b+g[f"crank_length_{i}"]*np.array([-np.cos(A),0,np.sin(A)])
        out.append(((M@t-e)**2).sum()/g[f"rod_length_{i}"]-g[f"rod_length_{i}"])
    return np.array(out)
rng=np.random.default_rng(0)
def roots(a):
    found=[]
    for _ in range(200):
        u=rng.uniform(-np.pi,np.pi,2)
        for _ in range(60):
            J=np.array([(res(u+1e-6*d,a)-res(u-1e-6*d,a))/2e-6 for d in np.eye(2)]).T
            try: s=np.linalg.solve(J,res(u,a))
            except np.linalg.LinAlgError: break
            u=u-s*min(1,.5/max(abs(s)))
        if abs(res(u,a)).max()<1e-9:
            u=(u+np.pi)%(2*np.pi)-np.pi
            if not any(abs(np.exp(1j*u)-np.exp(1j*v)).max()<1e-5 for v in found): found.append(u)
    return found
from collections import Counter
counts=Counter(); hit=0; N=40; inv=0
for a in rng.uniform(-45,45,(N,2)):
    f=roots(a); counts[len(f)]+=1
    try: fr,c=r.forward(a)
    except softkin.KinematicsError as e: print(a,e); continue
    z=np.array(fr.rotation)
    hit+=any(abs(R(*u)-z).max()<1e-7 for u in f)
    # inverse at the reached pose: both cranks by a circle, 2 each
    n=0
    for s in r.changed(check_forward=False,min_type2_margin=0).inverse_all(fr,a):
        if s.axes is not None:
            n+=1; assert abs(res([np.arctan2(-z[2,0],z[0,0]),np.arctan2(-z[1,2],z[1,1])],s.axes)).max()<1e-9
    inv=max(inv,n)
print("solutions of forward by number of poses",counts,"forward is one of them",hit,"of",N,"most inverse",inv)
