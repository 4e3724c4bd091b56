(* The order of flights under a gravity A that varies with time, y'' = -a(distance from the contact), a > 0, where ln a
   is concave: of two launches at one distance the faster is ahead at each impact.  So at most one launch has impacts
   that accumulate at the contact; slower ones than one whose chatter ends before it do the same. *)

From Coq Require Import Reals Lra Lia.
From Coquelicot Require Import Coquelicot.
Open Scope R_scope.

Section Order.

Variables (a : R -> R) (far r : R).
Hypothesis continuous_a : forall x, continuous a x.
Hypothesis positive : forall x, 0 < x -> 0 < a x.
Hypothesis r_positive : 0 < r.
(* ln a is concave: a (x + w) / a x falls as x grows. *)
Hypothesis concave : forall x y w, 0 <= x <= y -> 0 <= w -> y + w <= far -> a x * a (y + w) <= a (x + w) * a y.

(* Launch speed times t of a flight of length t from the distance e, and landing speed times t of one that lands there. *)
Definition launch (e t : R) : R := RInt (fun w => (t - w) * a (e - w)) 0 t.
Definition landing (e t : R) : R := RInt (fun w => (t - w) * a (e + w)) 0 t.

Lemma integrable (g : R -> R) p q : (forall x, continuous g x) -> ex_RInt g p q.
Proof. intros C; apply (ex_RInt_continuous g); intros; apply C. Qed.

Lemma part_continuous (k : R -> R) t x : (forall z, continuous k z) -> continuous (fun w => (t - w) * a (k w)) x.
Proof.
  intros K; apply (continuous_mult (fun w => t - w) (fun w => a (k w))).
  - apply (continuous_minus (fun _ => t) (fun w => w)); [apply continuous_const | apply continuous_id].
  - apply (continuous_comp k a); [apply K | apply continuous_a].
Qed.

Lemma beyond_continuous e t x : continuous (fun w => (t - w) * a (e + w)) x.
Proof.
  apply (part_continuous (fun w => e + w)); intros z.
  apply (continuous_plus (fun _ => e) (fun w => w)); [apply continuous_const | apply continuous_id].
Qed.

Lemma before_continuous e t x : continuous (fun w => (t - w) * a (e - w)) x.
Proof.
  apply (part_continuous (fun w => e - w)); intros z.
  apply (continuous_minus (fun _ => e) (fun w => w)); [apply continuous_const | apply continuous_id].
Qed.

(* Both speeds rise with the length. *)
Lemma rises (k : R -> R) s t : 0 < s < t -> (forall z, continuous (fun w => (s - w) * k w) z) ->
  (forall z, continuous (fun w => (t - w) * k w) z) -> (forall w, 0 < w < t -> 0 < k w) ->
  t * RInt (fun w => (s - w) * k w) 0 s < s * RInt (fun w => (t - w) * k w) 0 t.
Proof.
  intros [S T] C D K.
  assert (E : forall p q, ex_RInt (fun w => (t - w) * k w) p q) by (intros; apply integrable, D).
  rewrite <- (RInt_Chasles (fun w => (t - w) * k w) 0 s t) by apply E.
  assert (0 < RInt (fun w => (t - w) * k w) s t).
  { apply RInt_gt_0; [lra | | intros w _; apply D]; intros w W; apply Rmult_lt_0_compat; [lra |]; apply K; lra. }
  assert (scal t (RInt (fun w => (s - w) * k w) 0 s) <= scal s (RInt (fun w => (t - w) * k w) 0 s)).
  { rewrite <- !RInt_scal by (apply integrable; assumption).
    apply RInt_le; [lra | apply (ex_RInt_scal (fun w => (s - w) * k w)), integrable, C
      | apply (ex_RInt_scal (fun w => (t - w) * k w)), E |].
    intros w W; unfold scal; simpl; unfold mult; simpl.
    assert (0 <= k w * (w * (t - s))) by (apply Rmult_le_pos; [apply Rlt_le, K; lra | apply Rmult_le_pos; lra]).
    nra. }
  unfold scal in *; simpl in *; unfold mult in *; simpl in *; unfold plus; simpl.
  assert (0 < s * RInt (fun w => (t - w) * k w) s t) by (apply Rmult_lt_0_compat; lra); lra.
Qed.

Lemma launch_rises e s t : 0 < s < t -> t <= e -> t * launch e s < s * launch e t.
Proof.
  intros S E; apply (rises (fun w => a (e - w))); [exact S | apply before_continuous | apply before_continuous |].
  intros w W; apply positive; lra.
Qed.

Lemma landing_rises e s t : 0 < e -> 0 < s <= t -> t * landing e s <= s * landing e t.
Proof.
  intros E [S T]; destruct T as [T | T]; [| subst; lra]; apply Rlt_le, (fun H => H (conj S T)); clear S T; intros S.
  apply (rises (fun w => a (e + w))); [exact S | apply beyond_continuous | apply beyond_continuous |].
  intros w W; apply positive; lra.
Qed.

(* Nearer to the contact flights land faster, against what a launch needs. *)
Lemma landing_nearer e e' t : 0 < e' <= e -> 0 < t -> e + t <= far -> a e' * landing e t <= a e * landing e' t.
Proof.
  intros E T F; unfold landing.
  assert (scal (a e') (RInt (fun w => (t - w) * a (e + w)) 0 t) <= scal (a e) (RInt (fun w => (t - w) * a (e' + w)) 0 t)).
  { rewrite <- !RInt_scal by (apply integrable, beyond_continuous).
    apply RInt_le; [lra | apply (ex_RInt_scal (fun w => (t - w) * a (e + w))), integrable, beyond_continuous
      | apply (ex_RInt_scal (fun w => (t - w) * a (e' + w))), integrable, beyond_continuous |].
    intros w W; unfold scal; simpl; unfold mult; simpl.
    assert (L := concave e' e w ltac:(lra) ltac:(lra) ltac:(lra)); nra. }
  exact H.
Qed.

Lemma launch_nearer e e' t : 0 < e' <= e -> 0 < t <= e' -> e <= far -> a e * launch e' t <= a e' * launch e t.
Proof.
  intros E T F; unfold launch.
  assert (scal (a e) (RInt (fun w => (t - w) * a (e' - w)) 0 t) <= scal (a e') (RInt (fun w => (t - w) * a (e - w)) 0 t)).
  { rewrite <- !RInt_scal by (apply integrable, before_continuous).
    apply RInt_le; [lra | apply (ex_RInt_scal (fun w => (t - w) * a (e' - w))), integrable, before_continuous
      | apply (ex_RInt_scal (fun w => (t - w) * a (e - w))), integrable, before_continuous |].
    intros w W; unfold scal; simpl; unfold mult; simpl.
    assert (L := concave (e' - w) (e - w) w ltac:(lra) ltac:(lra) ltac:(lra)).
    replace (e - w + w) with e in L by ring; replace (e' - w + w) with e' in L by ring; nra. }
  exact H.
Qed.

(* The next flight, of length x after one of length t that lands at e. *)
Definition follows e t x : Prop := 0 < x < e /\ t * launch e x = r * (x * landing e t).

Lemma next_is_longer e e' t t' x x' : 0 < e' <= e -> 0 < t <= t' -> e + t <= far -> e' + t' <= far ->
  follows e t x -> follows e' t' x' -> x <= x'.
Proof.
  intros E T F F' [X N] [X' N']; destruct (Rle_or_lt x x') as [|L]; [assumption | exfalso].
  assert (A : 0 < a e) by (apply positive; lra); assert (A' : 0 < a e') by (apply positive; lra).
  (* speeds of launch and landing, from the times *)
  set (p := launch e x / x); set (p' := launch e' x' / x'); set (q := landing e t / t); set (q' := landing e' t' / t').
  assert (P : p = r * q) by (unfold p, q; apply (Rmult_eq_reg_l (t * x)); [| nra]; field_simplify; lra).
  assert (P' : p' = r * q') by (unfold p', q'; apply (Rmult_eq_reg_l (t' * x')); [| nra]; field_simplify; lra).
  assert (H1 : a e * p' <= a e' * (launch e x' / x')).
  { unfold p'; apply (Rmult_le_reg_l x'); [lra |].
    replace (x' * (a e * (launch e' x' / x'))) with (a e * launch e' x') by (field; lra).
    replace (x' * (a e' * (launch e x' / x'))) with (a e' * launch e x') by (field; lra).
    apply launch_nearer; lra. }
  assert (H2 : launch e x' / x' < p).
  { unfold p; apply (Rmult_lt_reg_l (x' * x)); [nra |].
    replace (x' * x * (launch e x' / x')) with (x * launch e x') by (field; lra).
    replace (x' * x * (launch e x / x)) with (x' * launch e x) by (field; lra).
    apply launch_rises; lra. }
  assert (H3 : a e' * q <= a e * (landing e' t / t)).
  { unfold q; apply (Rmult_le_reg_l t); [lra |].
    replace (t * (a e' * (landing e t / t))) with (a e' * landing e t) by (field; lra).
    replace (t * (a e * (landing e' t / t))) with (a e * landing e' t) by (field; lra).
    apply landing_nearer; lra. }
  assert (H4 : landing e' t / t <= q').
  { unfold q'; apply (Rmult_le_reg_l (t * t')); [nra |].
    replace (t * t' * (landing e' t / t)) with (t' * landing e' t) by (field; lra).
    replace (t * t' * (landing e' t' / t')) with (t * landing e' t') by (field; lra).
    apply landing_rises; lra. }
  assert (H5 : a e' * (launch e x' / x') < a e' * p) by (apply Rmult_lt_compat_l; assumption).
  assert (H6 : r * (a e' * q) <= r * (a e * (landing e' t / t))) by (apply Rmult_le_compat_l; lra).
  assert (H7 : r * (a e * (landing e' t / t)) <= r * (a e * q')) by (apply Rmult_le_compat_l, Rmult_le_compat_l; lra).
  rewrite P in H5; rewrite P' in H1.
  replace (a e' * (r * q)) with (r * (a e' * q)) in H5 by ring.
  replace (a e * (r * q')) with (r * (a e * q')) in H1 by ring; lra.
Qed.

(* Two launches at one distance whose orbits have infinitely many impacts before the contact. *)
Variables (start : R) (e t e' t' : nat -> R).
Hypothesis within : start <= far.
Hypothesis first : e 0%nat = start - t 0%nat /\ e' 0%nat = start - t' 0%nat.
Hypothesis faster : 0 < t 0%nat < t' 0%nat.
Hypothesis before : forall n, 0 < e n /\ 0 < e' n.
Hypothesis next : forall n, e (S n) = e n - t (S n) /\ follows (e n) (t n) (t (S n)).
Hypothesis next' : forall n, e' (S n) = e' n - t' (S n) /\ follows (e' n) (t' n) (t' (S n)).

Lemma ahead n : e' n <= e n - (t' 0%nat - t 0%nat) /\ 0 < t n <= t' n /\ e n + t n <= far /\ e' n + t' n <= far.
Proof.
  induction n as [| n [E [T [F F']]]]; [destruct first; repeat split; lra |].
  destruct (next n) as [N Y]; destruct (next' n) as [N' Y']; destruct (before n) as [B B'].
  assert (L : t (S n) <= t' (S n)) by (apply (next_is_longer (e n) (e' n) (t n) (t' n)); try assumption; lra).
  destruct Y as [Y _]; destruct Y' as [Y' _]; rewrite N, N'; repeat split; lra.
Qed.

(* Where the faster one ends before the contact, so does the slower one, no nearer. *)
Theorem slower_ends_no_nearer rest : (forall n, rest < e' n) -> forall n, rest < e n.
Proof. intros H n; destruct (ahead n) as [E _]; specialize (H n); lra. Qed.

(* Not both of them tend to the contact. *)
Theorem one_tends_to_the_contact : ~ (is_lim_seq e 0 /\ is_lim_seq e' 0).
Proof.
  intros [H H']; assert (D : is_lim_seq (fun n => e n - e' n) 0).
  { replace (Finite 0) with (Finite (0 - 0)) by (f_equal; ring); apply (is_lim_seq_minus' e e' 0 0); assumption. }
  assert (L : Rbar_le (t' 0%nat - t 0%nat) 0).
  { apply (is_lim_seq_le (fun _ => t' 0%nat - t 0%nat) (fun n => e n - e' n)); [| apply is_lim_seq_const | exact D].
    intros n; destruct (ahead n); lra. }
  simpl in L; lra.
Qed.

End Order.

Print Assumptions one_tends_to_the_contact.
