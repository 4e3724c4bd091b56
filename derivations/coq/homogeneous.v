(* Impacts before a contact of order j in the homogeneous model x'' = +-t^j, whose forms are exact (`motion`): for every
   j and every restitution r in (0, 1) there is one invariant ratio lambda; orbits of longer flights than on its ray
   have finitely many impacts before the contact, those of shorter flights accumulate before it. *)

From Coq Require Import Reals Lra Lia.
From Contact Require Import ratios fates.
Open Scope R_scope.

Section Homogeneous.

Variables (j : nat) (r : R).
Hypothesis r_inside : 0 < r < 1.

Lemma quotient_at_most a b c : 0 < b -> a <= c * b -> a / b <= c.
Proof. intros H W. apply (Rmult_le_reg_r b); [exact H|]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l; lra. Qed.

Lemma quotient_at_least a b c : 0 < b -> c * b <= a -> c <= a / b.
Proof. intros H W. apply (Rmult_le_reg_r b); [exact H|]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l; lra. Qed.

Lemma quotient_below_1 a b : 0 < b -> a < b -> a / b < 1.
Proof. intros H W. apply (Rmult_lt_reg_r b); [exact H|]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l; lra. Qed.

Lemma quotient_above_1 a b : 0 < b -> b < a -> 1 < a / b.
Proof. intros H W. apply (Rmult_lt_reg_r b); [exact H|]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l; lra. Qed.

Lemma powers_continuous k x : continuity_pt (powers k) x.
Proof.
  induction k as [|k IH]; [apply continuity_pt_const; now intros|].
  apply (continuity_pt_plus (powers k) (fun y => y ^ S k)); [exact IH|].
  apply derivable_continuous_pt, derivable_pt_pow.
Qed.

Lemma P_continuous k x : continuity_pt (P k) x.
Proof.
  induction k as [|k IH]; [apply continuity_pt_const; now intros|].
  apply (continuity_pt_plus (P k) (powers (S k))); [exact IH|apply powers_continuous].
Qed.

Lemma Q_continuous k x : continuity_pt (Q k) x.
Proof.
  induction k as [|k IH]; [apply continuity_pt_const; now intros|].
  apply (continuity_pt_plus (Q k) (fun y => INR (S (S k)) * y ^ S k)); [exact IH|].
  apply (continuity_pt_scal (fun y => y ^ S k)), derivable_continuous_pt, derivable_pt_pow.
Qed.

Lemma pow_continuous k x : continuity_pt (fun y => y ^ k) x.
Proof. apply derivable_continuous_pt, derivable_pt_pow. Qed.

Lemma Q_at_least_1 l : 0 <= l -> 1 <= Q j l.
Proof.
  intro H. induction j as [|k IH]; [simpl; lra|].
  change (Q (S k) l) with (Q k l + INR (S (S k)) * l ^ S k).
  assert (0 <= INR (S (S k)) * l ^ S k) by (apply Rmult_le_pos; [apply pos_INR|now apply pow_le]). lra.
Qed.

Lemma D_at_0 : D j 0 = INR (S j).
Proof. unfold D. rewrite P_at_0. ring. Qed.

Lemma D_at_1 : D j 1 = 0.
Proof. unfold D. ring. Qed.

Lemma D_apart a b : 0 <= a -> a <= b -> b - a <= D j a - D j b.
Proof.
  intros Ha [Hab|E]; [|subst; lra].
  destruct (MVT_cor2 (D j) (fun x => - Q j x) a b Hab (fun c _ => launch_falls j c)) as [c [E [Hc _]]].
  assert (W := Q_at_least_1 c ltac:(lra)). nra.
Qed.

Lemma D_order a b : 0 <= a -> 0 <= b -> D j b <= D j a -> a <= b.
Proof.
  intros Ha Hb H. apply Rnot_lt_le. intro F. assert (W := launch_decreases j b a Hb F). lra.
Qed.

(* ---- the ratio of the next flight *)

Lemma inverse y : {x : R | 0 <= y <= INR (S j) -> 0 <= x <= 1 /\ D j x = y}.
Proof.
  destruct (Rle_dec 0 y) as [H0|H0]; [|exists 0; lra].
  destruct (Rle_dec y (INR (S j))) as [H1|H1]; [|exists 0; lra].
  destruct (IVT_cor (fun x => D j x - y) 0 1) as [x [Hx E]].
  - intro x. apply (continuity_pt_minus (D j) (fun _ => y)); [apply D_continuous|].
    apply continuity_pt_const. now intros.
  - lra.
  - rewrite D_at_0, D_at_1. nra.
  - exists x. intros _. split; [exact Hx|lra].
Qed.

Definition ratio_of y := proj1_sig (inverse y).

Lemma ratio_of_is y : 0 <= y <= INR (S j) -> 0 <= ratio_of y <= 1 /\ D j (ratio_of y) = y.
Proof. intro H. unfold ratio_of. destruct (inverse y) as [x W]. now apply W. Qed.

Lemma ratio_of_near y z : 0 <= y <= INR (S j) -> 0 <= z <= INR (S j) ->
  Rabs (ratio_of y - ratio_of z) <= Rabs (y - z).
Proof.
  intros Hy Hz. destruct (ratio_of_is y Hy) as [Iy Ey]. destruct (ratio_of_is z Hz) as [Iz Ez].
  destruct (Rle_dec (ratio_of y) (ratio_of z)) as [C|C].
  - assert (W := D_apart _ _ (proj1 Iy) C). rewrite Ey, Ez in W. rewrite Rabs_left1, Rabs_right; lra.
  - assert (W := D_apart (ratio_of z) (ratio_of y) (proj1 Iz) ltac:(lra)). rewrite Ey, Ez in W.
    rewrite Rabs_right, Rabs_left1; lra.
Qed.

(* launch velocity after a flight of ratio l, in units of b (l S)^(j+1) *)
Definition rebound l := r * (1 - l) * Q j l / l ^ S j.
Definition after l := ratio_of (Rmin (rebound l) (INR (S j))).
Definition T l := r * Q j l / (l ^ S j * P j (after l)).

Lemma rebound_not_negative l : 0 < l <= 1 -> 0 <= rebound l.
Proof.
  intro H. unfold rebound. assert (W := Q_positive j l ltac:(lra)).
  apply Rmult_le_pos; [apply Rmult_le_pos; [apply Rmult_le_pos; lra|lra]|].
  left. apply Rinv_0_lt_compat, pow_lt. lra.
Qed.

Lemma launch_in_range l : 0 < l <= 1 -> 0 <= Rmin (rebound l) (INR (S j)) <= INR (S j).
Proof.
  intro H. split; [apply Rmin_glb; [now apply rebound_not_negative|apply pos_INR]|apply Rmin_r].
Qed.

Lemma after_of l : 0 < l <= 1 -> 0 <= after l <= 1 /\ D j (after l) = Rmin (rebound l) (INR (S j)).
Proof. intro H. now apply ratio_of_is, launch_in_range. Qed.

Lemma rebound_continuous m : 0 < m -> continuity_pt rebound m.
Proof.
  intro H. apply (continuity_pt_div (fun l => r * (1 - l) * Q j l) (fun l => l ^ S j)).
  - apply (continuity_pt_mult (fun l => r * (1 - l)) (Q j)); [|apply Q_continuous].
    apply (continuity_pt_mult (fun _ => r) (fun l => 1 - l)); [apply continuity_pt_const; now intros|].
    apply (continuity_pt_minus (fun _ => 1) (fun l => l)); [apply continuity_pt_const; now intros|].
    apply derivable_continuous_pt, derivable_pt_id.
  - apply pow_continuous.
  - apply Rgt_not_eq. now apply pow_lt.
Qed.

Lemma min_near a b c : Rabs (Rmin a c - Rmin b c) <= Rabs (a - b).
Proof.
  unfold Rmin. destruct (Rle_dec a c), (Rle_dec b c); unfold Rabs; repeat destruct Rcase_abs; lra.
Qed.

Lemma eventually_near (f : R -> R) m : continuity_pt f m -> forall eps, 0 < eps -> exists d, 0 < d /\
  forall l, Rabs (l - m) < d -> Rabs (f l - f m) < eps.
Proof.
  intros H eps He. destruct (H eps He) as [d [Hd W]]. exists d. split; [exact Hd|]. intros l Hl.
  destruct (Req_dec l m) as [E|N]; [subst; now rewrite Rminus_diag_eq, Rabs_R0|].
  apply W. split; [split; [exact I|auto]|exact Hl].
Qed.

Lemma after_near m : 0 < m <= 1 -> forall eps, 0 < eps -> exists d, 0 < d /\
  forall l, 0 < l <= 1 -> Rabs (l - m) < d -> Rabs (after l - after m) < eps.
Proof.
  intros Hm eps He. destruct (eventually_near rebound m (rebound_continuous m ltac:(lra)) eps He) as [d [Hd W]].
  exists d. split; [exact Hd|]. intros l Hl C. specialize (W l C).
  apply Rle_lt_trans with (2 := W).
  apply Rle_trans with (1 := ratio_of_near _ _ (launch_in_range l Hl) (launch_in_range m Hm)). apply min_near.
Qed.

Lemma T_near m : 0 < m <= 1 -> forall eps, 0 < eps -> exists d, 0 < d /\
  forall l, 0 < l <= 1 -> Rabs (l - m) < d -> Rabs (T l - T m) < eps.
Proof.
  intros Hm eps He.
  (* T as a function of two numbers, one of which is the next ratio *)
  set (g := fun l => r * Q j l / l ^ S j). set (h := fun x => / P j x).
  assert (P0 : forall x, 0 <= x -> 1 <= P j x).
  { intros x Hx. apply Rle_trans with (P j 0); [|apply P_grows; lra].
    rewrite P_at_0. change 1 with (INR 1). apply le_INR. lia. }
  assert (gc : continuity_pt g m).
  { apply (continuity_pt_div (fun l => r * Q j l) (fun l => l ^ S j)).
    - apply continuity_pt_scal, Q_continuous.
    - apply pow_continuous.
    - apply Rgt_not_eq, pow_lt. lra. }
  assert (am := proj1 (after_of m Hm)).
  assert (hc : continuity_pt h (after m)).
  { apply continuity_pt_inv; [apply P_continuous|]. specialize (P0 (after m) ltac:(lra)). lra. }
  assert (form : forall l, 0 < l <= 1 -> T l = g l * h (after l)).
  { intros l Hl. unfold T, g, h. assert (A := proj1 (after_of l Hl)). specialize (P0 (after l) ltac:(lra)).
    assert (0 < l ^ S j) by (apply pow_lt; lra). field. split; lra. }
  set (G := Rabs (g m) + 1). assert (G1 : 1 <= G) by (unfold G; assert (W := Rabs_pos (g m)); lra).
  destruct (eventually_near g m gc (Rmin 1 (eps / 2))) as [d1 [H1 W1]]; [apply Rmin_glb_lt; lra|].
  destruct (eventually_near h (after m) hc (eps / (2 * G))) as [d2 [H2 W2]]; [apply Rdiv_lt_0_compat; lra|].
  destruct (after_near m Hm d2 H2) as [d3 [H3 W3]].
  exists (Rmin d1 d3). split; [now apply Rmin_glb_lt|]. intros l Hl C.
  rewrite (form l Hl), (form m Hm).
  assert (C1 := W1 l ltac:(apply Rlt_le_trans with (1 := C), Rmin_l)).
  assert (C3 := W2 _ (W3 l Hl ltac:(apply Rlt_le_trans with (1 := C), Rmin_r))).
  assert (Hh : 0 <= h (after m) <= 1).
  { unfold h. specialize (P0 (after m) ltac:(lra)). split; [left; apply Rinv_0_lt_compat; lra|].
    rewrite <- Rinv_1. apply Rinv_le_contravar; lra. }
  replace (g l * h (after l) - g m * h (after m))
    with ((g l - g m) * h (after m) + g l * (h (after l) - h (after m))) by ring.
  apply Rle_lt_trans with (1 := Rabs_triang _ _). rewrite !Rabs_mult. rewrite (Rabs_right (h (after m))) by lra.
  assert (gl : Rabs (g l) <= G).
  { unfold G. replace (g l) with ((g l - g m) + g m) by ring. apply Rle_trans with (1 := Rabs_triang _ _).
    assert (W := Rmin_l 1 (eps / 2)). lra. }
  assert (E1 : Rabs (g l - g m) * h (after m) < eps / 2 \/ Rabs (g l - g m) * h (after m) <= eps / 2).
  { right. assert (W := Rmin_r 1 (eps / 2)). assert (X := Rabs_pos (g l - g m)). nra. }
  assert (E2 : Rabs (g l) * Rabs (h (after l) - h (after m)) < eps / 2).
  { apply Rle_lt_trans with (G * Rabs (h (after l) - h (after m))).
    - apply Rmult_le_compat_r; [apply Rabs_pos|exact gl].
    - apply Rlt_le_trans with (G * (eps / (2 * G))); [apply Rmult_lt_compat_l; lra|].
      right. field. lra. }
  destruct E1; lra.
Qed.

(* ---- the invariant ratio *)

Theorem one_ratio : exists lambda, 0 < lambda < 1 /\ lambda ^ S j * P j lambda = r * Q j lambda.
Proof.
  destruct (IVT_cor (fun l => l ^ S j * P j l - r * Q j l) 0 1) as [x [Hx E]].
  - intro x. apply (continuity_pt_minus (fun l => l ^ S j * P j l) (fun l => r * Q j l)).
    + apply (continuity_pt_mult (fun l => l ^ S j) (P j)); [apply pow_continuous|apply P_continuous].
    + apply continuity_pt_scal, Q_continuous.
  - lra.
  - rewrite pow1, pow_i, equal_at_rest by lia. assert (A := Q_positive j 0 ltac:(lra)).
    assert (B := Q_positive j 1 ltac:(lra)).
    replace ((0 * P j 0 - r * Q j 0) * (1 * Q j 1 - r * Q j 1)) with (- ((r * (1 - r)) * (Q j 0 * Q j 1))) by ring.
    assert (0 < (r * (1 - r)) * (Q j 0 * Q j 1)) by (apply Rmult_lt_0_compat; apply Rmult_lt_0_compat; lra). lra.
  - exists x. assert (B := Q_positive j x ltac:(lra)). split; [|lra].
    destruct Hx as [[H0|H0] [H1|H1]]; [lra|subst x|subst x|lra].
    + rewrite pow1, equal_at_rest in E. nra.
    + rewrite pow_i in E by lia. nra.
Qed.

(* the ray, of which there is one *)
Variable lambda : R.
Hypothesis lambda_inside : 0 < lambda < 1.
Hypothesis invariant : lambda ^ S j * P j lambda = r * Q j lambda.

Lemma beyond l : lambda < l -> r * Q j l < l ^ S j * P j l.
Proof.
  intro H. assert (W := restitution_rises j lambda l ltac:(lra) H). rewrite invariant in W.
  assert (B := Q_positive j lambda ltac:(lra)). nra.
Qed.

Lemma within l : 0 < l < lambda -> l ^ S j * P j l < r * Q j l.
Proof.
  intros H. assert (W := restitution_rises j l lambda ltac:(lra) ltac:(lra)). rewrite invariant in W.
  assert (B := Q_positive j lambda ltac:(lra)). nra.
Qed.

Theorem the_only_ratio m : 0 < m < 1 -> m ^ S j * P j m = r * Q j m -> m = lambda.
Proof.
  intros H E. destruct (Rtotal_order m lambda) as [C|[C|C]]; [|exact C|].
  - assert (W := within m ltac:(lra)). lra.
  - assert (W := beyond m C). lra.
Qed.

(* its sign says on which side of 1 T is *)
Definition drift l := l ^ S j * P j l / Q j l - r.

Lemma drift_sign l : 0 < l -> drift l * Q j l = l ^ S j * P j l - r * Q j l.
Proof. intro W. assert (B := Q_positive j l ltac:(lra)). unfold drift. field. lra. Qed.

Lemma drift_rises x y : 0 < x -> x < y -> drift x < drift y.
Proof.
  intros Hx Hy. assert (W := restitution_rises j x y ltac:(lra) Hy). assert (A := drift_sign x Hx).
  assert (B := drift_sign y ltac:(lra)).
  assert (X := Q_positive j x ltac:(lra)). assert (Y := Q_positive j y ltac:(lra)).
  apply (Rmult_lt_reg_r (Q j x * Q j y)); [now apply Rmult_lt_0_compat|].
  replace (drift x * (Q j x * Q j y)) with (drift x * Q j x * Q j y) by ring.
  replace (drift y * (Q j x * Q j y)) with (drift y * Q j y * Q j x) by ring. rewrite A, B. nra.
Qed.

Lemma drift_on_the_ray : drift lambda = 0.
Proof. assert (W := drift_sign lambda ltac:(lra)). assert (B := Q_positive j lambda ltac:(lra)). nra. Qed.

Lemma T_below_1 l : 0 < l <= 1 -> 0 < drift l -> T l < 1.
Proof.
  intros W sign. assert (B : r * Q j l < l ^ S j * P j l).
  { assert (E := drift_sign l ltac:(lra)). assert (X := Q_positive j l ltac:(lra)). nra. }
  destruct (after_of l ltac:(lra)) as [A E].
  assert (pw : 0 < l ^ S j) by (apply pow_lt; lra).
  assert (longer : l <= after l).
  { apply D_order; [lra|lra|]. rewrite E. apply Rle_trans with (1 := Rmin_l _ _).
    apply quotient_at_most; [exact pw|]. unfold D. nra. }
  assert (G := P_grows j l (after l) ltac:(lra)). assert (Pl := P_positive j l ltac:(lra)).
  apply quotient_below_1; nra.
Qed.

Lemma T_above_1 l : 0 < l <= 1 -> drift l < 0 -> 1 < T l.
Proof.
  intros W sign. assert (B : l ^ S j * P j l < r * Q j l).
  { assert (E := drift_sign l ltac:(lra)). assert (X := Q_positive j l ltac:(lra)). nra. }
  destruct (after_of l ltac:(lra)) as [A E].
  assert (pw : 0 < l ^ S j) by (apply pow_lt; lra).
  assert (shorter : after l <= l).
  { apply D_order; [lra|lra|]. rewrite E. apply Rmin_glb.
    - apply quotient_at_least; [exact pw|]. unfold D. nra.
    - rewrite <- D_at_0. left. apply launch_decreases; lra. }
  assert (G := P_grows j (after l) l ltac:(lra)). assert (Pl := P_positive j (after l) ltac:(lra)).
  apply quotient_above_1; nra.
Qed.

(* ---- orbits: sigma = -s n, ratio l n, and the launch velocity is r times that of the landing before *)

Variables s l : nat -> R.
Hypothesis start : 0 < s 0%nat.
Hypothesis ratio : forall n, 0 < l n < 1.
Hypothesis next : forall n, s (S n) = l n * s n.
Hypothesis reset : forall n, D j (l (S n)) * l n ^ S j = r * (1 - l n) * Q j (l n).

Lemma launch_is n : D j (l (S n)) = rebound (l n).
Proof.
  assert (H := ratio n). assert (pw : 0 < l n ^ S j) by (apply pow_lt; lra).
  unfold rebound. rewrite <- reset. field. lra.
Qed.

Lemma launch_below n : D j (l n) < INR (S j).
Proof. rewrite <- D_at_0. apply launch_decreases; [lra|apply ratio]. Qed.

Lemma after_is n : l (S n) = after (l n).
Proof.
  assert (H := ratio n). assert (H' := ratio (S n)). destruct (after_of (l n) ltac:(lra)) as [A E].
  rewrite Rmin_left in E by (rewrite <- launch_is; left; apply launch_below). rewrite <- launch_is in E.
  apply Rle_antisym; apply D_order; lra.
Qed.

Lemma changes n : (1 - l (S n)) / (1 - lambda) = T (l n) * ((1 - l n) / (1 - lambda)).
Proof.
  assert (H := ratio n). assert (H' := ratio (S n)). assert (pw : 0 < l n ^ S j) by (apply pow_lt; lra).
  assert (Pl := P_positive j (l (S n)) ltac:(lra)). assert (W := reset n). unfold D in W.
  unfold T. rewrite <- after_is.
  assert (F : 1 - l (S n) = r * Q j (l n) * (1 - l n) / (l n ^ S j * P j (l (S n)))).
  { apply (Rmult_eq_reg_r (l n ^ S j * P j (l (S n)))); [|apply Rgt_not_eq; nra].
    unfold Rdiv. rewrite Rmult_assoc, Rinv_l by (apply Rgt_not_eq; nra). lra. }
  rewrite F. field. repeat split; lra.
Qed.

Let e := r / INR (S (S j)).

Lemma last_flight n : e <= l n.
Proof.
  assert (H := ratio n). apply Rnot_lt_le. intro F. assert (W := reset n). assert (B := launch_below (S n)).
  assert (Q1 := Q_at_least_1 (l n) ltac:(lra)).
  assert (N : 0 < INR (S (S j))) by (apply lt_0_INR; lia).
  assert (F' : l n * INR (S (S j)) < r).
  { unfold e in F. apply (Rmult_lt_compat_r (INR (S (S j)))) in F; [|exact N].
    unfold Rdiv in F. rewrite Rmult_assoc, Rinv_l in F; lra. }
  rewrite (S_INR (S j)) in F'. assert (N' : 0 < INR (S j)) by (apply lt_0_INR; lia).
  assert (D0 : 0 <= D j (l (S n))) by (unfold D; assert (H' := ratio (S n)); apply Rmult_le_pos;
    [lra|left; apply P_positive; lra]).
  assert (pw : l n ^ S j <= l n).
  { simpl. assert (l n ^ j <= 1 ^ j) by (apply pow_incr; lra). rewrite pow1 in *. nra. }
  assert (pw0 : 0 < l n ^ S j) by (apply pow_lt; lra).
  assert (W1 : D j (l (S n)) * l n ^ S j <= INR (S j) * l n) by (apply Rmult_le_compat; lra).
  assert (W2 : r * (1 - l n) <= r * (1 - l n) * Q j (l n)).
  { rewrite <- (Rmult_1_r (r * (1 - l n))) at 1. apply Rmult_le_compat_l; [|exact Q1]. apply Rmult_le_pos; lra. }
  nra.
Qed.

Lemma constant_tends : forall eps, 0 < eps -> exists d, 0 < d /\
  forall x, 0 <= x <= s 0%nat -> x < d -> Rabs (lambda - lambda) < eps.
Proof. intros eps He. exists 1. split; [lra|]. intros. now rewrite Rminus_diag_eq, Rabs_R0. Qed.

Lemma T_tends_at m : 0 < m <= 1 -> forall eps, 0 < eps -> exists d, 0 < d /\
  forall x y, 0 <= x <= s 0%nat -> x < d -> 0 < y <= 1 -> Rabs (y - m) < d -> Rabs (T y - T m) < eps.
Proof.
  intros Hm eps He. destruct (T_near m Hm eps He) as [d [Hd W]]. exists d. split; [exact Hd|].
  intros. now apply W.
Qed.

Theorem shorter_flights_chatter : lambda < l 0%nat -> exists rest, 0 < rest < s 0%nat /\ Un_cv s rest /\ Un_cv l 1.
Proof.
  apply chatter_is_complete with (S0 := s 0%nat) (lambda := lambda) (L1 := lambda) (L := fun _ => lambda)
    (drift := fun _ => drift) (T := fun _ => T); auto; try lra.
  - intros. lra.
  - exact constant_tends.
  - intros x y z _. intros. now apply drift_rises.
  - intros _ _. exact drift_on_the_ray.
  - intros x y _. apply T_below_1.
  - exact T_tends_at.
  - exact changes.
Qed.

Theorem longer_flights_end : ~ l 0%nat < lambda.
Proof.
  apply impacts_before_the_contact_end with (S0 := s 0%nat) (lambda := lambda) (L1 := lambda) (e := e)
    (L := fun _ => lambda) (drift := fun _ => drift) (T := fun _ => T) (s := s); auto; try lra.
  - unfold e. apply Rdiv_lt_0_compat; [lra|]. apply lt_0_INR. lia.
  - intros. lra.
  - exact constant_tends.
  - intros x y z _. intros. now apply drift_rises.
  - intros _ _. exact drift_on_the_ray.
  - intros x y _. apply T_above_1.
  - exact T_tends_at.
  - exact changes.
  - intros n _. apply last_flight.
Qed.

Theorem on_the_ray_all_ratios_are_equal : l 0%nat = lambda -> forall n, l n = lambda.
Proof.
  intros H n. induction n as [|k IH]; [exact H|].
  assert (W := reset k). rewrite IH in W. unfold D in W. assert (A := ratio (S k)).
  assert (pw : 0 < lambda ^ S j) by (apply pow_lt; lra).
  assert (E : D j (l (S k)) = D j lambda).
  { unfold D. apply (Rmult_eq_reg_r (lambda ^ S j)); [|lra]. rewrite W.
    replace ((1 - lambda) * P j lambda * lambda ^ S j) with ((1 - lambda) * (lambda ^ S j * P j lambda)) by ring.
    rewrite invariant. ring. }
  apply Rle_antisym; apply D_order; lra.
Qed.

(* all fates before the contact: complete chatter there, finitely many impacts, or the ray into the contact *)
Theorem fates :
  (lambda < l 0%nat -> exists rest, 0 < rest < s 0%nat /\ Un_cv s rest /\ Un_cv l 1) /\
  ~ l 0%nat < lambda /\
  (l 0%nat = lambda -> forall n, l n = lambda).
Proof. exact (conj shorter_flights_chatter (conj longer_flights_end on_the_ray_all_ratios_are_equal)). Qed.

End Homogeneous.
