(* Flights of linear oscillators x'' + d x' + k x = g(t) above a wall, in Coq's real numbers: what the files of
   `singimpact certify --format coq` rest on. *)
From Coq Require Import Reals Lra.
From Coquelicot Require Import Coquelicot.
Open Scope R_scope.

(* y answers the forcing g: it is a motion, dy its velocity. *)
Definition answers (d k : R) (g y dy : R -> R) : Prop :=
  forall t, is_derive y t (dy t) /\ is_derive dy t (g t - d * dy t - k * y t).

Lemma answers_sum (d k : R) (g h y z dy dz : R -> R) :
  answers d k g y dy -> answers d k h z dz ->
  answers d k (fun t => g t + h t) (fun t => y t + z t) (fun t => dy t + dz t).
Proof.
  intros Y Z t; destruct (Y t) as [Y1 Y2]; destruct (Z t) as [Z1 Z2]; split.
  - apply (is_derive_plus y z); assumption.
  - replace (g t + h t - d * (dy t + dz t) - k * (y t + z t))
      with (plus (g t - d * dy t - k * y t) (h t - d * dz t - k * z t)) by (unfold plus; simpl; ring).
    apply (is_derive_plus dy dz); assumption.
Qed.

Lemma answers_constant (d k m : R) : k <> 0 -> answers d k (fun _ => m) (fun _ => m / k) (fun _ => 0).
Proof.
  intros K t; split; [auto_derive; trivial | auto_derive; trivial; field; exact K].
Qed.

(* p cos + q sin of rate a and phase e, and what answers it. *)
Definition wave (a e p q t : R) : R := p * cos (a * t + e) + q * sin (a * t + e).
Definition size (d k a : R) : R := (k - a * a) * (k - a * a) + d * a * (d * a).
Definition answer (d k a e p q t : R) : R :=
  wave a e (((k - a * a) * p - d * a * q) / size d k a) (((k - a * a) * q + d * a * p) / size d k a) t.
Definition answer' (d k a e p q t : R) : R :=
  wave a e (a * ((k - a * a) * q + d * a * p) / size d k a) (- a * ((k - a * a) * p - d * a * q) / size d k a) t.

Lemma answers_wave (d k a e p q : R) : size d k a <> 0 ->
  answers d k (wave a e p q) (answer d k a e p q) (answer' d k a e p q).
Proof.
  intros N t; unfold answer, answer', wave; split; auto_derive; trivial;
  set (c := cos (a * t + e)); set (s := sin (a * t + e)); unfold size in *; field; exact N.
Qed.

(* The motion from height 0 above the wall c with velocity v at the time tau, s after it: y answers g. *)
Section Motion.
Variables (d k c tau v : R) (g y dy : R -> R).
Hypothesis oscillates : 0 < k - d / 2 * (d / 2).
Hypothesis steady : answers d k g y dy.
Definition rate : R := sqrt (k - d / 2 * (d / 2)).
Definition start : R := c - y tau.
Definition slope : R := (v - dy tau + d / 2 * start) / rate.
Definition height (s : R) : R :=
  y (tau + s) + (exp (- (d / 2) * s) * (start * cos (rate * s) + slope * sin (rate * s)) - c).
Definition velocity (s : R) : R :=
  dy (tau + s) + exp (- (d / 2) * s) *
    ((rate * slope - d / 2 * start) * cos (rate * s) - (rate * start + d / 2 * slope) * sin (rate * s)).

Lemma rate_positive : 0 < rate.
Proof. apply sqrt_lt_R0; exact oscillates. Qed.

Lemma rate_squared : rate * rate = k - d / 2 * (d / 2).
Proof. apply sqrt_sqrt; lra. Qed.

Lemma later (f : R -> R) (s l : R) : is_derive f (tau + s) l -> is_derive (fun u => f (tau + u)) s l.
Proof.
  intros D; replace l with (scal 1 l) by (unfold scal; simpl; unfold mult; simpl; ring).
  apply (is_derive_comp f (fun u => tau + u)); [exact D | auto_derive; trivial].
Qed.

Theorem moves (s : R) :
  is_derive height s (velocity s) /\
  is_derive velocity s (g (tau + s) - d * velocity s - k * (height s + c)).
Proof.
  destruct (steady (tau + s)) as [Y1 Y2]; apply later in Y1; apply later in Y2; split.
  - unfold height, velocity.
    apply (is_derive_plus (fun u => y (tau + u))); [exact Y1 | auto_derive; trivial; ring].
  - unfold velocity at 1.
    replace (g (tau + s) - d * velocity s - k * (height s + c)) with
      (plus (g (tau + s) - d * dy (tau + s) - k * y (tau + s))
        (- d * (velocity s - dy (tau + s)) - k * (height s + c - y (tau + s)))) by (unfold plus; simpl; ring).
    apply (is_derive_plus (fun u => dy (tau + u))); [exact Y2 |].
    unfold velocity, height; auto_derive; trivial.
    assert (W := rate_squared); set (E := exp _); set (C := cos _); set (S := sin _); set (w := rate) in *.
    set (A := start); set (B := slope).
    replace k with (w * w + d / 2 * (d / 2)) by lra; field.
Qed.

Lemma launched : height 0 = 0 /\ velocity 0 = v.
Proof.
  unfold height, velocity; rewrite Rplus_0_r, !Rmult_0_r, exp_0, cos_0, sin_0; split.
  - unfold start; ring.
  - assert (P := rate_positive); unfold slope; field; lra.
Qed.
End Motion.

(* A flight that is back at the wall after a time T, without a hit before. *)
Theorem returns (x dx : R -> R) (s1 s2 T : R) :
  (forall s, is_derive x s (dx s)) -> x 0 = 0 -> 0 < s1 <= s2 -> s2 < T ->
  (forall s, 0 <= s <= s1 -> 0 < dx s) -> (forall s, s1 <= s <= s2 -> 0 < x s) ->
  (forall s, s2 <= s <= T -> dx s < 0) -> x T = 0 -> forall s, 0 < s < T -> 0 < x s.
Proof.
  intros D X0 [S1 S2] L up above down E s S.
  assert (M : forall p q, p < q -> exists m, p <= m <= q /\ x q - x p = dx m * (q - p)).
  { intros p q pq; destruct (MVT_gen x p q dx) as [m [I F]].
    - intros; apply D.
    - intros t _; apply derivable_continuous_pt; exists (dx t); apply is_derive_Reals, D.
    - exists m; rewrite Rmin_left, Rmax_right in I by lra; split; [exact I | exact F]. }
  destruct (Rle_or_lt s s1).
  - destruct (M 0 s) as [m [J F]]; [lra |]; assert (0 < dx m) by (apply up; lra).
    assert (0 < dx m * (s - 0)) by (apply Rmult_lt_0_compat; lra); lra.
  - destruct (Rle_or_lt s s2); [apply above; lra |].
    destruct (M s T) as [m [J F]]; [lra |]; assert (dx m < 0) by (apply down; lra).
    assert (0 < - dx m * (T - s)) by (apply Rmult_lt_0_compat; lra); lra.
Qed.

(* The first hit: up at first, above the wall, then down through it. *)
Theorem first_hit (x dx : R -> R) (s1 s2 low high : R) :
  (forall s, is_derive x s (dx s)) -> x 0 = 0 -> 0 < s1 <= s2 -> s2 <= low < high ->
  (forall s, 0 <= s <= s1 -> 0 < dx s) -> (forall s, s1 <= s <= s2 -> 0 < x s) ->
  (forall s, s2 <= s <= high -> dx s < 0) -> 0 < x low -> x high < 0 ->
  exists T, low < T < high /\ x T = 0 /\ forall s, 0 < s < T -> 0 < x s.
Proof.
  intros D X0 S L up above down before after.
  destruct (IVT_gen x low high 0) as [T [I E]].
  - intros s; apply derivable_continuous_pt; exists (dx s); apply is_derive_Reals, D.
  - rewrite Rmin_right, Rmax_left by lra; lra.
  - rewrite Rmin_left, Rmax_right in I by lra.
    assert (low <> T) by (intros F; rewrite F in before; lra).
    assert (T <> high) by (intros F; rewrite <- F in after; lra).
    exists T; split; [lra | split; [exact E |]].
    apply (returns x dx s1 s2 T); try assumption; [lra | intros s B; apply down; lra].
Qed.

(* What the velocity of the launch adds. *)
Definition gain' (d k s : R) : R :=
  exp (- (d / 2) * s) * (cos (rate d k * s) - d / 2 * sin (rate d k * s) / rate d k).

Lemma by_velocity' (d k c tau v : R) (y dy : R -> R) (oscillates : 0 < k - d / 2 * (d / 2)) (s : R) :
  velocity d k c tau v y dy s = velocity d k c tau 0 y dy s + v * gain' d k s.
Proof.
  assert (P := rate_positive d k oscillates); unfold velocity, slope, gain'; field; lra.
Qed.

Lemma vanishes (f : R -> R) (low high : R) : low <= high -> (forall t, continuous f t) -> f low * f high < 0 ->
  exists t, low <= t <= high /\ f t = 0.
Proof.
  intros L C A; destruct (IVT_gen f low high 0) as [t [I E]].
  - intros t; apply continuity_pt_filterlim, C.
  - unfold Rmin, Rmax; destruct (Rle_dec (f low) (f high)); nra.
  - rewrite Rmin_left, Rmax_right in I by lra; exists t; split; assumption.
Qed.
